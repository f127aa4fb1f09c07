/** The stop channel: one WebSocket for the stops of every rig, open from the page's first moment, its round trip known. */
import type { sockets } from "../contract/schema";
import type { CommandDone, Urgent } from "../contract/types";
import { problemOf, type ApiError } from "./errors";
import { me } from "./identity";
import { BROWSER, KeptSocket, type Surroundings } from "./keptSocket";
import { socketTo } from "./request";

type Answer = sockets["/api/v1/stop"]["answered"];
type Ask = sockets["/api/v1/stop"]["sent"];

/** How long an answer may take [ms]: the server gives one within 250. */
export const ANSWER_MS = 1000;

/** What a press of Stop needs; null where the channel is not open, or did not answer: then it goes over HTTP. */
export interface StopLine {
  press: (what: Urgent, rig: string) => Promise<CommandDone | null>;
  close: () => void;
}

/** Opens a channel; it tells its round trip [ms], null while it is down, and that it was not let in. */
export type OpenStopLine = (roundTrip: (ms: number | null) => void, refused: () => void) => StopLine;

export const openStopLine: OpenStopLine = (roundTrip, refused) =>
  new StopChannel(roundTrip, BROWSER, undefined, refused);

interface Waiting {
  answer: (done: CommandDone | null) => void;
  refuse: (error: ApiError) => void;
}

export class StopChannel implements StopLine {
  readonly #socket: KeptSocket;
  #number = 0;
  readonly #waiting = new Map<number, Waiting>();

  constructor(
    private readonly roundTrip: (ms: number | null) => void,
    private readonly around: Surroundings = BROWSER,
    url: string = socketTo("/api/v1/stop", {}),
    refused: () => void = () => undefined,
  ) {
    const socket = {
      opened: () => this.#socket.settle(),
      received: (data: unknown) => this.#receive(data),
      lost: () => this.#lost(),
      refused,
    };
    this.#socket = new KeptSocket(url, socket, around);
  }

  close = (): void => {
    this.#socket.close();
    this.#lost();
  };

  press = (what: Urgent, rig: string): Promise<CommandDone | null> => {
    if (!this.#socket.settled) return Promise.resolve(null);
    const id = ++this.#number;
    return new Promise((resolve, reject) => {
      const timer = this.around.setTimeout(() => this.#settle(id, null), ANSWER_MS);
      const ended = () => this.around.clearTimeout(timer);
      this.#waiting.set(id, {
        answer: (done) => {
          ended();
          resolve(done);
        },
        refuse: (error) => {
          ended();
          reject(error);
        },
      });
      this.#say({ type: what, rig, client: me(), id });
    });
  };

  #say(message: Ask): void {
    this.#socket.send(message);
  }

  #receive(data: unknown): void {
    const message = JSON.parse(String(data)) as Answer;
    switch (message.type) {
      case "pong":
        this.roundTrip(this.around.now() - message.t);
        break;
      case "stopped":
        this.#settle(message.id, message.done);
        break;
      case "problem":
        this.#refuse(message.id, problemOf(message.problem.status, message.problem.detail, message.problem));
        break;
      default:
        message satisfies never;
    }
  }

  #settle(id: number, done: CommandDone | null): void {
    this.#waiting.get(id)?.answer(done);
    this.#waiting.delete(id);
  }

  /** Refuses the press of that number; a message that was none has no number. */
  #refuse(id: number | null | undefined, error: ApiError): void {
    const waiting = this.#waiting.get(id ?? 0);
    this.#waiting.delete(id ?? 0);
    waiting?.refuse(error);
  }

  #lost(): void {
    this.roundTrip(null);
    for (const id of [...this.#waiting.keys()]) this.#settle(id, null);
  }
}
