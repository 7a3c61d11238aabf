// Splits the code of a WebAssembly module into streams, and joins them again. Opcodes are in one stream, and variables,
// memory offsets, constants and functions in others; each stream has more repetition than their mixture, and compresses
// better. Lengths of functions follow from their ends. Alignments are hints without an effect on results; they are
// omitted, and come back as 0.

type Bytes = Uint8Array<ArrayBuffer>;

const enum Stream {
  Before,
  After,
  Counts,
  Operations,
  Types,
  Labels,
  Functions,
  Variables,
  Globals,
  Places,
  Integers,
  Reals,
}

const STREAMS = 12;
const CODE = 10;

// Reads bytes.
class Reader {
  at = 0;

  constructor(readonly bytes: Bytes) {}

  // Reads a byte, and copies it to `to`.
  byte(to?: Writer): number {
    const byte = this.bytes[this.at++];
    if (byte === undefined) {
      throw new Error("the module ends too early");
    }
    to?.byte(byte);
    return byte;
  }

  // Reads a LEB128 number, and copies its bytes to `to`. The value is correct below 32 bits, as for lengths; values of
  // longer numbers are not used.
  number(to?: Writer): number {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = this.byte(to);
      value |= (byte & 127) << shift;
      if (byte < 128) {
        return value;
      }
    }
  }

  some(count: number): Bytes {
    return this.bytes.subarray(this.at, (this.at += count));
  }
}

// Writes bytes to a growing buffer.
class Writer {
  private bytes: Bytes = new Uint8Array(1 << 16);
  private length = 0;

  private reserve(end: number): void {
    if (end > this.bytes.length) {
      const wider = new Uint8Array(2 * end);
      wider.set(this.written());
      this.bytes = wider;
    }
  }

  byte(byte: number): void {
    this.reserve(this.length + 1);
    this.bytes[this.length++] = byte;
  }

  put(more: Bytes): void {
    this.reserve(this.length + more.length);
    this.bytes.set(more, this.length);
    this.length += more.length;
  }

  number(value: number): void {
    for (; value >= 128; value >>>= 7) {
      this.byte((value & 127) | 128);
    }
    this.byte(value);
  }

  clear(): void {
    this.length = 0;
  }

  written(): Bytes {
    return this.bytes.subarray(0, this.length);
  }
}

// Operations of a walk over the code, for splitting or joining.
interface Hand {
  // The next opcode, one byte.
  operation(): number;
  // The next number of a stream.
  number(stream: Stream): number;
  // The next bytes of a stream.
  bytes(stream: Stream, count: number): void;
  // The alignment of a memory access.
  alignment(): void;
  // A function body, preceded by its length.
  body(walk: () => void): void;
}

// Walks over all functions of a module.
function walk(hand: Hand): void {
  for (let count = hand.number(Stream.Counts); count > 0; count--) {
    hand.body(() => {
      for (let kinds = hand.number(Stream.Counts); kinds > 0; kinds--) {
        hand.number(Stream.Counts);
        hand.bytes(Stream.Counts, 1);
      }
      // The body itself counts as a block.
      for (let depth = 1; depth > 0; ) {
        depth += instruction(hand);
      }
    });
  }
}

// Opcodes with one number, by the stream of the number: block, loop, if, memory.size, memory.grow, ref.null; br, br_if; call,
// ref.func; local.get, local.set, local.tee; global.get, global.set, table.get, table.set; i32.const, i64.const.
const ONE: (Stream | undefined)[] = [];
for (const [stream, operations] of [
  [Stream.Types, [0x02, 0x03, 0x04, 0x3f, 0x40, 0xd0]],
  [Stream.Labels, [0x0c, 0x0d]],
  [Stream.Functions, [0x10, 0xd2]],
  [Stream.Variables, [0x20, 0x21, 0x22]],
  [Stream.Globals, [0x23, 0x24, 0x25, 0x26]],
  [Stream.Integers, [0x41, 0x42]],
] as const) {
  operations.forEach((operation) => (ONE[operation] = stream));
}

// Opcodes without operands: unreachable, nop, else, end, return, drop, select, ref.is_null. Arithmetic has none either.
const NONE = [0x00, 0x01, 0x05, 0x0b, 0x0f, 0x1a, 0x1b, 0xd1];

// Number of operands of the opcodes after 0xfc: saturating truncations, then bulk operations on memories and tables.
const MORE = [0, 0, 0, 0, 0, 0, 0, 0, 2, 1, 2, 1, 2, 1, 2, 1, 1, 1];

// Walks over an instruction with its operands; returns the change of the block depth.
function instruction(hand: Hand): number {
  const operation = hand.operation();
  const stream = ONE[operation];
  const numbers = (stream: Stream, count: number) => {
    for (; count > 0; count--) {
      hand.number(stream);
    }
  };
  if (stream !== undefined) {
    hand.number(stream);
  } else if (operation >= 0x28 && operation <= 0x3e) {
    // Loads and stores.
    hand.alignment();
    hand.number(Stream.Places);
  } else if (operation === 0x0e) {
    // br_table
    numbers(Stream.Labels, hand.number(Stream.Labels) + 1);
  } else if (operation === 0x11) {
    // call_indirect
    numbers(Stream.Types, 2);
  } else if (operation === 0x43 || operation === 0x44) {
    // f32.const, f64.const
    hand.bytes(Stream.Reals, operation === 0x43 ? 4 : 8);
  } else if (operation === 0xfc) {
    const further = hand.operation();
    numbers(Stream.Types, MORE[further] ?? unknown(further));
  } else if (!NONE.includes(operation) && !(operation >= 0x45 && operation <= 0xc4)) {
    unknown(operation);
  }
  return operation >= 0x02 && operation <= 0x04 ? 1 : operation === 0x0b ? -1 : 0;
}

function unknown(operation: number): never {
  throw new Error(`unsupported WebAssembly instruction: opcode ${operation}`);
}

// Splits a module into streams, concatenated after a list of their lengths.
export function splitStreams(module: Bytes): Bytes {
  const from = new Reader(module);
  const streams = Array.from({ length: STREAMS }, () => new Writer());
  const stream = (index: Stream) => streams[index] as Writer;
  stream(Stream.Before).put(from.some(8));
  let rest = Stream.Before;
  while (from.at < module.length) {
    const start = from.at;
    const [section, length] = [from.number(), from.number()];
    if (section === CODE) {
      walk({
        operation: () => from.byte(stream(Stream.Operations)),
        number: (index) => from.number(stream(index)),
        bytes: (index, count) => stream(index).put(from.some(count)),
        alignment: () => void from.number(),
        body(walk) {
          const end = from.number() + from.at;
          walk();
          if (from.at !== end) {
            throw new Error("a function does not end where its length says");
          }
        },
      });
      rest = Stream.After;
    } else {
      from.at += length;
      stream(rest).put(module.subarray(start, from.at));
    }
  }
  const whole = new Writer();
  streams.forEach((stream) => whole.number(stream.written().length));
  streams.forEach((stream) => whole.put(stream.written()));
  return whole.written();
}

// Joins the streams of a module.
export function joinStreams(streams: Bytes): Bytes {
  const all = new Reader(streams);
  const lengths = Array.from({ length: STREAMS }, () => all.number());
  const readers = lengths.map((length) => new Reader(all.some(length)));
  const stream = (index: Stream) => readers[index] as Reader;
  const [code, body] = [new Writer(), new Writer()];
  let to = code;
  walk({
    operation: () => stream(Stream.Operations).byte(to),
    number: (index) => stream(index).number(to),
    bytes: (index, count) => to.put(stream(index).some(count)),
    alignment: () => to.number(0),
    body(walk) {
      body.clear();
      to = body;
      walk();
      to = code;
      code.number(body.written().length);
      code.put(body.written());
    },
  });
  const module = new Writer();
  module.put(stream(Stream.Before).bytes);
  module.number(CODE);
  module.number(code.written().length);
  module.put(code.written());
  module.put(stream(Stream.After).bytes);
  return module.written();
}
