// SPDX-License-Identifier: MIT
// The socket of the door: questions with ids, answers in any order, and a connection that comes back by itself.

/** Answered by the door with an error; `code` is that of HTTP. */
export class DoorError extends Error {
  constructor(message: string, readonly code: number) {
    super(message);
  }
}

/** The connection was lost, or is not there yet. */
export class DoorLost extends Error {
  constructor() {
    super('the connection to camway is lost');
  }
}

/** A newer question of the same drag took the place of this one. */
export class Superseded extends Error {}

type Message = Record<string, unknown>;

interface Waiting {
  readonly done: (message: Message) => void;
  readonly failed: (error: Error) => void;
  /** Messages that are no end: progress and events. */
  readonly onPart: ((message: Message) => void) | undefined;
}

const kFirstPause_ms = 250;
const kLongestPause_ms = 4000;

export class DoorSocket {
  private socket: WebSocket | undefined;
  private readonly waiting = new Map<number, Waiting>();
  private lastId = 0;
  private pause_ms = kFirstPause_ms;

  /** `onState` hears of each connection that was made or lost. */
  constructor(
    private readonly address: string,
    private readonly onState: (isOpen: boolean) => void,
  ) {}

  open(): void {
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.addEventListener('open', () => {
      this.pause_ms = kFirstPause_ms;
      this.onState(true);
    });
    socket.addEventListener('message', ({ data }) => this.receive(String(data)));
    socket.addEventListener('close', () => {
      this.socket = undefined;
      const lost = [...this.waiting.values()];
      this.waiting.clear();
      for (const { failed } of lost) failed(new DoorLost());
      this.onState(false);
      setTimeout(() => this.open(), this.pause_ms);
      this.pause_ms = Math.min(2 * this.pause_ms, kLongestPause_ms);
    });
  }

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Asks, and resolves with the last message of the answer. Rejects with DoorError, DoorLost or Superseded. */
  ask(message: Message, onPart?: (message: Message) => void): { id: number; answer: Promise<Message> } {
    const id = ++this.lastId;
    const answer = new Promise<Message>((done, failed) => {
      if (!this.isOpen) {
        failed(new DoorLost());
        return;
      }
      this.waiting.set(id, { done, failed, onPart });
      this.socket?.send(JSON.stringify({ id, ...message }));
    });
    return { id, answer };
  }

  /** Sends what has the id of an earlier question, such as `cancel` and `unwatch`. */
  tell(id: number, what: string): void {
    if (this.isOpen) this.socket?.send(JSON.stringify({ id, do: what }));
  }

  private receive(text: string): void {
    const message = JSON.parse(text) as Message;
    const id = message['id'];
    const waiting = typeof id === 'number' ? this.waiting.get(id) : undefined;
    if (!waiting || typeof id !== 'number') return;
    if ('progress' in message || 'event' in message) {
      waiting.onPart?.(message);
      return;
    }
    this.waiting.delete(id);
    if ('error' in message) waiting.failed(new DoorError(String(message['error']), Number(message['code'] ?? 500)));
    else if (message['superseded'] === true) waiting.failed(new Superseded());
    else waiting.done(message);
  }
}
