// The generator as the page sees it: requests and their answers. A worker that is busy with an old text is ended, and
// one that stands by takes its place, so that nobody waits for what nobody wants any more.

import type { Opened } from "./answers";

interface Reply {
  number: number;
  answer?: string;
  numbers?: Float32Array;
  fault?: string;
}

interface Waiting {
  resolve(value: unknown): void;
  reject(error: Error): void;
}

// The answer to a request that a newer text has made pointless.
export class Dropped extends Error {}

export class Generator {
  private worker: Worker;
  private standby: Worker;
  private waiting = new Map<number, Waiting>();
  private next = 0;

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly source: string,
  ) {
    this.worker = this.started();
    this.standby = this.started();
  }

  // Reads and derives a text. Whatever was being done for an older one is dropped.
  open(text: string, name: string): Promise<Opened> {
    this.drop();
    return this.ask<Opened>("open", { text, name });
  }

  async ask<T>(what: string, request: object = {}): Promise<T> {
    const number = this.next++;
    const answer = new Promise<unknown>((resolve, reject) => {
      this.waiting.set(number, { resolve, reject });
    });
    this.worker.postMessage({ number, request: { ...request, do: what } });
    return answer as Promise<T>;
  }

  // Ends what is being worked on.
  drop(): void {
    if (this.waiting.size === 0) {
      return;
    }
    this.worker.terminate();
    this.worker = this.standby;
    this.standby = this.started();
    this.refuse(new Dropped("a newer text has come"));
    this.worker.onmessage = (event: MessageEvent<Reply>) => this.take(event.data);
  }

  private started(): Worker {
    const address = URL.createObjectURL(new Blob([this.source], { type: "text/javascript" }));
    const worker = new Worker(address);
    URL.revokeObjectURL(address);
    worker.postMessage(this.module);
    worker.onmessage = (event: MessageEvent<Reply>) => this.take(event.data);
    return worker;
  }

  private take(reply: Reply): void {
    const waiting = this.waiting.get(reply.number);
    this.waiting.delete(reply.number);
    if (waiting === undefined) {
      return;
    }
    if (reply.fault !== undefined || reply.answer === undefined) {
      waiting.reject(new Error(`the generator stopped: ${reply.fault}`));
      this.refuse(new Error(`the generator stopped: ${reply.fault}`));
      this.worker.terminate();
      this.worker = this.standby;
      this.standby = this.started();
      return;
    }
    const answer = JSON.parse(reply.answer) as { done?: unknown; error?: string };
    if (answer.error !== undefined) {
      waiting.reject(new Error(answer.error));
    } else {
      const numbers = reply.numbers ?? new Float32Array();
      waiting.resolve(numbers.length > 0 ? { ...(answer.done as object), numbers } : answer.done);
    }
  }

  private refuse(error: Error): void {
    for (const waiting of this.waiting.values()) {
      waiting.reject(error);
    }
    this.waiting.clear();
  }
}
