// Worker that runs the generator: it receives the compiled module, then one request after another.

interface Exports {
  memory: WebAssembly.Memory;
  hamel_room(bytes: number): number;
  hamel_answer(): number;
  hamel_said(): number;
  hamel_count(): number;
  hamel_numbers(): number;
}

interface Asked {
  number: number;
  request: unknown;
}

interface Scope {
  onmessage: (event: MessageEvent<WebAssembly.Module | Asked>) => void;
  postMessage(message: unknown, transferred?: Transferable[]): void;
}

const scope = self as unknown as Scope;
const encoder = new TextEncoder();
const decoder = new TextDecoder();
let generator: Promise<Exports> | undefined;

scope.onmessage = async (event) => {
  if (event.data instanceof WebAssembly.Module) {
    generator = WebAssembly.instantiate(event.data).then(
      (instance) => instance.exports as unknown as Exports,
    );
    return;
  }
  const { number, request } = event.data;
  if (generator === undefined) {
    return;
  }
  try {
    const to = await generator;
    const answer = ask(to, JSON.stringify(request));
    const numbers = new Float32Array(to.memory.buffer, to.hamel_numbers(), to.hamel_count()).slice();
    scope.postMessage({ number, answer, numbers }, [numbers.buffer]);
  } catch (fault) {
    // A trap, after which the memory of the module is not valid.
    scope.postMessage({ number, fault: String(fault) });
  }
};

function ask(to: Exports, request: string): string {
  const bytes = encoder.encode(request);
  const room = to.hamel_room(bytes.length);
  new Uint8Array(to.memory.buffer, room, bytes.length).set(bytes);
  const length = to.hamel_answer();
  return decoder.decode(new Uint8Array(to.memory.buffer, to.hamel_said(), length));
}
