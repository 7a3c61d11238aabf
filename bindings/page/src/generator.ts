// Client of the generator: sends requests to a worker and returns promises of the answers. A worker that is busy with
// an outdated text is terminated, and a standby worker takes its place.

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

// Rejection of a request that a newer text or request has superseded.
export class Superseded extends Error {}

// Time that a new request waits for older work before terminating it (ms).
const TERMINATE_AFTER_MS = 2000;

export class Generator {
  private worker: Worker;
  private standby: Worker;
  private waiting = new Map<number, Waiting>();
  private next = 0;
  // The open description, and whether a former standby worker has yet to open it.
  private last: { text: string; name: string } | undefined;
  private unopened = false;
  // Callbacks for the time when no request is pending.
  private readonly idle: (() => void)[] = [];
  // Number of the latest request of `instead`.
  private urgent = 0;

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly source: string,
  ) {
    this.worker = this.started();
    this.standby = this.started();
  }

  // Reads and derives a text, and drops all work on an older one.
  open(text: string, name: string): Promise<Opened> {
    this.drop();
    this.last = { text, name };
    this.unopened = false;
    return this.post<Opened>("open", this.last);
  }

  async ask<T>(what: string, request: object = {}): Promise<T> {
    if (this.unopened && this.last !== undefined) {
      this.unopened = false;
      this.post("open", this.last).catch(() => {});
    }
    return this.post<T>(what, request);
  }

  // Sends a request that supersedes older ones, whose work is terminated if it takes too long.
  async instead<T>(what: string, request: object): Promise<T> {
    const urgent = ++this.urgent;
    if (this.waiting.size > 0) {
      await new Promise<void>((resolve) => {
        setTimeout(resolve, TERMINATE_AFTER_MS);
        this.idle.push(resolve);
      });
      if (urgent !== this.urgent) {
        throw new Superseded("something newer is wanted");
      }
      this.drop();
    }
    return this.ask<T>(what, request);
  }

  private async post<T>(what: string, request: object): Promise<T> {
    const number = this.next++;
    const answer = new Promise<unknown>((resolve, reject) => {
      this.waiting.set(number, { resolve, reject });
    });
    this.worker.postMessage({ number, request: { ...request, do: what } });
    return answer as Promise<T>;
  }

  // Terminates all pending work.
  drop(): void {
    if (this.waiting.size === 0) {
      return;
    }
    this.replace();
    this.refuse(new Superseded("a newer text has come"));
  }

  // Terminates the worker, and replaces it by the standby worker.
  private replace(): void {
    this.worker.terminate();
    this.worker = this.standby;
    this.standby = this.started();
    this.unopened = true;
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
      this.replace();
      return;
    }
    this.rest();
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
    this.rest();
  }

  // Runs the idle callbacks if no request is pending.
  private rest(): void {
    if (this.waiting.size === 0) {
      this.idle.splice(0).forEach((resolve) => resolve());
    }
  }
}
