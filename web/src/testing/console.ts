/** A console for tests: real stores, on a server and a stream that the test answers for. */
import { render, type RenderResult } from "@testing-library/svelte";
import type { Component } from "svelte";
import type { CommandDone, Snapshot } from "../contract/types";
import { api, type Api } from "../net/api";
import type { OpenStopLine } from "../net/stopChannel";
import type { Connect, Listener } from "../net/stream";
import { makeLasting, makeStores, type Stores } from "../state/stores";
import Within from "./Within.svelte";

export class TestConsole {
  readonly stores: Stores;
  /** What was asked of the server, and with what. */
  readonly asked: [request: string, ...with_: unknown[]][] = [];
  /** What the stop channel answers; null: it is down. */
  channel: CommandDone | null = null;
  #listener: Listener | null = null;
  #roundTrip: (ms: number | null) => void = () => undefined;

  /** `answers`: what the server says to a request: a value, an error, or either by what a rig is asked. */
  constructor(answers: { [Request in keyof Api]?: unknown } = {}) {
    const server = new Proxy(api, {
      get: (real, request: keyof Api) => {
        if (request.endsWith("Url")) return real[request];
        return (...given: unknown[]) => {
          this.asked.push([request, ...given]);
          const said = answers[request];
          const answer: unknown = typeof said === "function" ? (said as (asked: unknown) => unknown)(given[1]) : said;
          if (answer instanceof Error) return Promise.reject(answer);
          return request in answers ? Promise.resolve(answer) : new Promise(() => undefined);
        };
      },
    });
    const connect: Connect = (_, listener) => {
      this.#listener = listener;
      return { close: () => undefined, control: () => undefined };
    };
    const line: OpenStopLine = (roundTrip) => {
      this.#roundTrip = roundTrip;
      return {
        close: () => undefined,
        press: (what, rig) => {
          if (!this.channel) return Promise.resolve(null);
          this.asked.push([`channel ${what}`, rig]);
          return Promise.resolve(this.channel);
        },
      };
    };
    this.stores = makeStores(makeLasting(server), server, connect, line);
  }

  /** Operates a rig whose session is this; fresh data is there. */
  operate(session: Snapshot): this {
    this.stores.operated.open(session.rig);
    this.#listener?.link({ type: "opened", session });
    this.#listener?.link({ type: "frame", seq: 1, dropped: 0, ageAtSendMs: 1, nowMs: performance.now() });
    this.#listener?.link({ type: "pong", roundTripMs: 1 });
    return this;
  }

  /** Takes in another snapshot of the session. */
  tell(session: Snapshot): void {
    this.#listener?.link({ type: "session", session });
  }

  /** Lets the newest data be this old [ms]. */
  grow(ageAtSendMs: number): void {
    this.#listener?.link({ type: "frame", seq: 2, dropped: 0, ageAtSendMs, nowMs: performance.now() });
    this.#listener?.link({ type: "pong", roundTripMs: 1 });
  }

  /** Opens the stop channel, that answers `done`. */
  openChannel(done: CommandDone, roundTripMs: number): this {
    this.channel = done;
    this.#roundTrip(roundTripMs);
    return this;
  }

  /** Loses the connection of the stream. */
  lose(): void {
    this.#listener?.link({ type: "closed", reason: "gone" });
  }

  /** Shows a component with the stores of this console. */
  show<Props extends Record<string, unknown>>(component: Component<Props>, props: Props): RenderResult<typeof Within> {
    return render(Within, { props: { stores: this.stores, component: component as Component, props } });
  }
}
