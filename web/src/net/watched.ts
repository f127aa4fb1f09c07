/** What the console asks through, with an eye on whether it is still let in. */
import type { Api } from "./api";
import type { OpenStopLine } from "./stopChannel";
import type { Connect } from "./stream";

/** Who is told. */
export interface Watch {
  /** A request was not answered as it was to be. */
  failed: (error: unknown) => void;
  /** A WebSocket was not let in, or is no longer. */
  refused: () => void;
}

type Ask = (...given: unknown[]) => unknown;

/** The same requests. */
export function watchedApi(asked: Api, watch: Watch): Api {
  return new Proxy(asked, {
    get: (real, name) => {
      const ask = Reflect.get(real, name) as Ask;
      return (...given: unknown[]): unknown => {
        const answer = ask(...given);
        return answer instanceof Promise ? told(answer, watch) : answer;
      };
    },
  });
}

/** The same streams. */
export function watchedConnect(open: Connect, { refused }: Watch): Connect {
  return (url, listener, helloMs) => open(url, { ...listener, refused }, helloMs);
}

/** The same stop channel: a press that is refused tells as much as a request. */
export function watchedLine(open: OpenStopLine, watch: Watch): OpenStopLine {
  return (roundTrip) => {
    const line = open(roundTrip, watch.refused);
    return { press: (what, rig) => told(line.press(what, rig), watch), close: line.close };
  };
}

function told<T>(answer: Promise<T>, { failed }: Watch): Promise<T> {
  return answer.catch((error: unknown) => {
    failed(error);
    throw error;
  });
}
