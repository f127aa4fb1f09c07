/** The stream client of one rig: owns the socket, the reconnects and the pings; decides nothing. */
import {
  STREAM_SCHEMA,
  type PlaybackControl,
  type Replayed,
  type ReplayOf,
  type ServerMessage,
  type Subscribe,
} from "../contract/types";
import type { LinkEvent } from "./link";
import { decodeBinary, decodeJson, FrameError, layoutOf, type Batch, type Layout } from "./telemetry";

export const PING_PERIOD_MS = 1000;
/** No word from the server for this long: the socket is dead even where the network has not said so. */
export const SILENCE_MS = 5000;
/** A server that has a record to read before it says hello is given this: to try again would begin that anew. */
export const RECORD_MS = 60_000;

/** Delay before attempt `n` (1, 2, ...): doubles from 250 ms to 5 s, spread so that consoles do not return in step. */
export function backoffMs(attempt: number, random: number): number {
  return Math.min(5000, 250 * 2 ** (attempt - 1)) * (0.75 + 0.5 * random);
}

/** The parts of WebSocket that this needs, so that a test can stand in for the network. */
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  send(text: string): void;
  close(): void;
}

export interface Surroundings {
  open: (url: string) => Socket;
  now: () => number;
  random: () => number;
  setTimeout: (run: () => void, ms: number) => number;
  clearTimeout: (id: number) => void;
}

export const BROWSER: Surroundings = {
  open: (url) => new WebSocket(url) as unknown as Socket,
  now: () => performance.now(),
  random: () => Math.random(),
  setTimeout: (run, ms) => window.setTimeout(run, ms),
  clearTimeout: (id) => window.clearTimeout(id),
};

export interface Listener {
  link: (event: LinkEvent) => void;
  batch: (batch: Batch) => void;
  /** A replay has been opened; what is sent to it now comes before the subscription. */
  replay?: (of: ReplayOf) => void;
  replayed?: (where: Replayed) => void;
}

/** What an opened stream is told. */
export type Connection = Pick<Stream, "close" | "control">;

/** Opens the stream at a URL; `helloMs` is how long the server may take to say hello. */
export type Connect = (url: string, listener: Listener, helloMs?: number) => Connection;

export const connect: Connect = (url, listener, helloMs) => new Stream(url, listener, BROWSER, 30, "binary", helloMs);

export class Stream {
  #socket: Socket | null = null;
  #layout: Layout | null = null;
  #attempt = 0;
  #timers = new Set<number>();
  #heardAt = 0;
  #closed = false;

  constructor(
    private readonly url: string,
    private readonly listener: Listener,
    private readonly around: Surroundings = BROWSER,
    private readonly rateHz = 30,
    private readonly encoding: Subscribe["encoding"] = "binary",
    /** How long the server may take to say hello. */
    private readonly helloMs = SILENCE_MS,
  ) {
    this.#connect();
  }

  close(): void {
    this.#closed = true;
    this.#drop();
  }

  /** Moves the clock of a replay. */
  control(message: PlaybackControl): void {
    if (this.#layout) this.#socket?.send(JSON.stringify(message));
  }

  #connect(): void {
    this.listener.link({ type: "connecting" });
    const socket = this.around.open(this.url);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#heardAt = this.around.now();
    socket.onmessage = ({ data }) => {
      this.#heardAt = this.around.now();
      this.#receive(data);
    };
    socket.onclose = ({ code, reason }) => this.#lost(reason || `connection closed (${code})`);
    this.#watch();
  }

  #receive(data: unknown): void {
    try {
      if (data instanceof ArrayBuffer) {
        if (this.#layout) this.#frame(decodeBinary(data, this.#layout));
      } else {
        this.#message(JSON.parse(String(data)) as ServerMessage);
      }
    } catch (error) {
      if (!(error instanceof FrameError || error instanceof SyntaxError)) throw error;
      this.listener.link({ type: "problem", message: error.message });
    }
  }

  #message(message: ServerMessage): void {
    switch (message.type) {
      case "hello": {
        const spoken: string = message.schema; // the contract says which; a server of another version does not keep to it
        if (spoken !== STREAM_SCHEMA) {
          throw new FrameError(`the server speaks ${spoken}, this console ${STREAM_SCHEMA}: reload the page`);
        }
        this.#layout = layoutOf(message.record);
        this.#attempt = 0;
        this.listener.link({ type: "opened", session: message.session });
        if (message.replay) this.listener.replay?.(message.replay);
        const subscribe: Subscribe = {
          type: "subscribe",
          topics: ["telemetry", "session"],
          rate_hz: this.rateHz,
          encoding: this.encoding,
          every_sample: false,
          since_seq: null,
        };
        this.#socket?.send(JSON.stringify(subscribe));
        this.#ping();
        break;
      }
      case "session":
        this.listener.link({ type: "session", session: message.session });
        break;
      case "replay":
        this.listener.replayed?.(message);
        break;
      case "telemetry":
        if (this.#layout) this.#frame(decodeJson(message, this.#layout));
        break;
      case "problem":
        this.listener.link({ type: "problem", message: message.problem.detail });
        break;
      case "pong":
        this.listener.link({ type: "pong", roundTripMs: this.around.now() - message.t });
        break;
      case "stopped": // the answer to a stop by this socket; the console stops over HTTP, and the session tells the rest
        break;
      default: // a message of the contract that has no case here does not compile; one of a newer server is passed over
        message satisfies never;
    }
  }

  #frame(batch: Batch): void {
    if (batch.count === 0) return;
    const wallNs = batch.columns.get("wall_ns")?.data[batch.count - 1] ?? NaN;
    this.listener.link({
      type: "frame",
      seq: batch.seq,
      dropped: batch.dropped,
      ageAtSendMs: (batch.serverTime - wallNs / 1e9) * 1000,
      nowMs: this.around.now(),
    });
    this.listener.batch(batch);
  }

  #ping(): void {
    this.#socket?.send(JSON.stringify({ type: "ping", t: this.around.now() }));
    this.#later(() => this.#ping(), PING_PERIOD_MS);
  }

  #watch(): void {
    this.#later(() => {
      if (this.around.now() - this.#heardAt > (this.#layout ? SILENCE_MS : this.helloMs))
        this.#lost("no word from the server");
      else this.#watch();
    }, PING_PERIOD_MS);
  }

  #lost(reason: string): void {
    if (this.#closed) return;
    this.#drop();
    this.listener.link({ type: "closed", reason });
    this.#attempt++;
    this.#later(() => this.#connect(), backoffMs(this.#attempt, this.around.random()));
  }

  #drop(): void {
    for (const id of this.#timers) this.around.clearTimeout(id);
    this.#timers.clear();
    const socket = this.#socket;
    this.#socket = null;
    this.#layout = null;
    if (socket) {
      socket.onmessage = socket.onclose = null;
      socket.close();
    }
  }

  #later(run: () => void, ms: number): void {
    const id = this.around.setTimeout(() => {
      this.#timers.delete(id);
      run();
    }, ms);
    this.#timers.add(id);
  }
}
