/** The stream client of one rig: reads what the server says, and decides nothing. */
import {
  STREAM_SCHEMA,
  type PlaybackControl,
  type Replayed,
  type ReplayOf,
  type ServerMessage,
  type Subscribe,
} from "../contract/types";
import { BROWSER, KeptSocket, SILENCE_MS, type Surroundings } from "./keptSocket";
import type { LinkEvent } from "./link";
import { decodeBinary, decodeJson, FrameError, layoutOf, type Batch, type Layout } from "./telemetry";

/** A server that has a record to read before it says hello is given this: to try again would begin that anew. */
export const RECORD_MS = 60_000;

export interface Listener {
  link: (event: LinkEvent) => void;
  batch: (batch: Batch) => void;
  /** A replay has been opened; what is sent to it now comes before the subscription. */
  replay?: (of: ReplayOf) => void;
  replayed?: (where: Replayed) => void;
  /** The server may not have let us in. */
  refused?: () => void;
}

/** What an opened stream is told. */
export type Connection = Pick<Stream, "close" | "control">;

/** Opens the stream at a URL; `helloMs` is how long the server may take to say hello. */
export type Connect = (url: string, listener: Listener, helloMs?: number) => Connection;

export const connect: Connect = (url, listener, helloMs) => new Stream(url, listener, BROWSER, 30, "binary", helloMs);

export class Stream {
  readonly #socket: KeptSocket;
  #layout: Layout | null = null;

  constructor(
    url: string,
    private readonly listener: Listener,
    private readonly around: Surroundings = BROWSER,
    private readonly rateHz = 30,
    private readonly encoding: Subscribe["encoding"] = "binary",
    /** How long the server may take to say hello. */
    helloMs = SILENCE_MS,
  ) {
    const socket = {
      connecting: () => this.listener.link({ type: "connecting" }),
      received: (data: unknown) => this.#receive(data),
      lost: (reason: string) => {
        this.#layout = null;
        this.listener.link({ type: "closed", reason });
      },
      refused: () => this.listener.refused?.(),
    };
    this.#socket = new KeptSocket(url, socket, around, helloMs);
  }

  close(): void {
    this.#socket.close();
  }

  /** Moves the clock of a replay. */
  control(message: PlaybackControl): void {
    if (this.#layout) this.#socket.send(message);
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
        this.#socket.send(subscribe);
        this.#socket.settle();
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
}
