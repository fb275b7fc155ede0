// One socket, one request in flight. Requests of one kind that wait give way to the latest; what is on its way when the
// server goes is sent again when it is back, since an answer depends on nothing but its request.
import { signal } from "@preact/signals";
import { type Frame, isFrame, readFrame } from "./protocol";
import { say } from "./words";

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

// What is quick never waits for what is slow: each has its own way to the server.
const SLOW = new Set(["panel"]);
type Lane = "quick" | "slow";

// Letters of a request: of a greater one the server would close the connection, again and again.
const MOST = 600_000;

export class Connection {
  private socket: WebSocket | null = null;
  private queues: Record<Lane, Waiting[]> = { quick: [], slow: [] };
  private flying: Record<Lane, Waiting | null> = { quick: null, slow: null };
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
    const lane: Lane = SLOW.has(request.do) ? "slow" : "quick", queue = this.queues[lane];
    if (JSON.stringify(request).length > MOST) return Promise.resolve({ error: { message: say("too_large") } });
    return new Promise((resolve) => {
      const kept = channel ? queue.findIndex((one) => one.channel === channel) : -1;
      if (kept >= 0) queue.splice(kept, 1)[0]!.resolve(SUPERSEDED);
      const one = { request, channel, resolve, id: ++this.number };
      queue.push(one);
      // A sheet of another description is not waited for: the server stops it.
      if (lane === "slow" && this.flying.slow && this.socket?.readyState === WebSocket.OPEN) {
        this.flying.slow.resolve(SUPERSEDED);
        this.flying.slow = null;
      }
      this.next(lane);
    });
  }

  private next(lane: Lane): void {
    const queue = this.queues[lane];
    if (this.flying[lane] || !queue.length || this.socket?.readyState !== WebSocket.OPEN) return;
    const urgent = queue.findIndex((one) => one.channel === "drag"); // a hand waits for it
    const one = queue.splice(Math.max(0, urgent), 1)[0]!;
    this.flying[lane] = one;
    this.send(one);
  }

  private send(one: Waiting): void {
    if (!SLOW.has(one.request.do)) busy.value = one.channel !== "drag";
    this.socket!.send(JSON.stringify({ id: one.id, ...one.request }));
  }

  private take(answer: any): void {
    const lane = (["quick", "slow"] as const).find((name) => this.flying[name]?.id === answer.id);
    const one = lane && this.flying[lane];
    if (!lane || !one) return; // of a request that nobody waits for any more
    if (!isFrame(answer) && answer.unknown && !one.request.text) {
      const text = this.texts.get(String(answer.unknown));
      if (text !== undefined) {
        one.request = { ...one.request, text };
        this.send(one);
        return;
      }
    }
    this.flying[lane] = null;
    busy.value = Boolean(this.flying.quick);
    one.resolve(answer.superseded ? SUPERSEDED : answer);
    this.next(lane);
  }

  private open(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.tries = 0;
      online.value = "open";
      for (const lane of ["quick", "slow"] as const) {
        if (this.flying[lane]) this.send(this.flying[lane]);
        else this.next(lane);
      }
      this.onopen();
    };
    socket.onmessage = (event) => this.take(typeof event.data === "string" ? JSON.parse(event.data) : readFrame(event.data));
    socket.onclose = () => {
      if (online.value === "open" || this.tries > 1) online.value = "lost";
      this.tries += 1;
      setTimeout(() => this.open(), Math.min(2000, 250 * 2 ** Math.min(this.tries, 4)));
    };
  }
}
