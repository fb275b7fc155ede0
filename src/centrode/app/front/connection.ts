// One socket, one request in flight. Requests of one kind that wait give way to the latest; what is on its way when the
// server goes is sent again when it is back, since an answer depends on nothing but its request.
import { signal } from "@preact/signals";
import { type Frame, isFrame, readFrame } from "./protocol";

export type Request = Record<string, unknown> & { do: string };
export type Answer = any;
export const SUPERSEDED = Symbol("superseded");

interface Waiting {
  request: Request;
  channel: string | null;
  resolve: (answer: Answer | Frame | typeof SUPERSEDED) => void;
  id: number;
}

export const online = signal<"connecting" | "open" | "lost">("connecting");
export const busy = signal(false);

export class Connection {
  private socket: WebSocket | null = null;
  private queue: Waiting[] = [];
  private flying: Waiting | null = null;
  private number = 0;
  private tries = 0;
  private texts = new Map<string, string>();
  onopen: () => void = () => undefined;

  constructor(private readonly address: string) {
    this.open();
  }

  // A text that the server may have to see again.
  know(digest: string, text: string): void {
    this.texts.delete(digest);
    this.texts.set(digest, text);
    if (this.texts.size > 40) this.texts.delete(this.texts.keys().next().value!);
  }

  ask(request: Request, channel: string | null = null): Promise<Answer> {
    return new Promise((resolve) => {
      if (channel) {
        const kept = this.queue.findIndex((one) => one.channel === channel);
        if (kept >= 0) {
          this.queue[kept]!.resolve(SUPERSEDED);
          this.queue.splice(kept, 1);
        }
      }
      this.queue.push({ request, channel, resolve, id: ++this.number });
      this.next();
    });
  }

  private next(): void {
    if (this.flying || !this.queue.length || this.socket?.readyState !== WebSocket.OPEN) return;
    // What a hand waits for goes first.
    const urgent = this.queue.findIndex((one) => one.channel === "drag");
    this.flying = this.queue.splice(Math.max(0, urgent), 1)[0]!;
    this.send(this.flying);
  }

  private send(one: Waiting): void {
    busy.value = one.channel !== "drag";
    this.socket!.send(JSON.stringify({ id: one.id, ...one.request }));
  }

  private take(answer: any): void {
    const one = this.flying;
    const id = isFrame(answer) ? answer.id : answer.id;
    if (!one || (id !== undefined && id !== null && id !== one.id)) return;
    if (!isFrame(answer) && answer.unknown && !one.request.text) {
      const text = this.texts.get(String(answer.unknown));
      if (text !== undefined) {
        one.request = { ...one.request, text };
        this.send(one);
        return;
      }
    }
    this.flying = null;
    busy.value = false;
    one.resolve(answer);
    this.next();
  }

  private open(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.tries = 0;
      online.value = "open";
      if (this.flying) this.send(this.flying);
      else this.next();
      this.onopen();
    };
    socket.onmessage = (event) => this.take(typeof event.data === "string" ? JSON.parse(event.data) : readFrame(event.data));
    socket.onclose = () => {
      if (online.value === "open" || this.tries > 1) online.value = "lost";
      this.tries += 1;
      setTimeout(() => this.open(), Math.min(3000, 250 * 2 ** Math.min(this.tries, 4)));
    };
  }
}
