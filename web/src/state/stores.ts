/** The console's stores: made at the root, and given to every component by context. */
import { createContext } from "svelte";
import { api, type Api } from "../net/api";
import { openStopLine, type OpenStopLine } from "../net/stopChannel";
import { connect, type Connect } from "../net/stream";
import { watchedApi, watchedConnect, watchedLine } from "../net/watched";
import { Alerts } from "./alerts.svelte";
import { Gathered } from "./circumstances.svelte";
import { Identity } from "./identity.svelte";
import { Library } from "./library.svelte";
import { Notices } from "./notices.svelte";
import { Operated } from "./rig.svelte";
import { Router } from "./router.svelte";
import { ThemeChoice } from "./theme.svelte";

/** What outlives a sign-out, of one page. */
export interface Lasting {
  readonly identity: Identity;
  readonly router: Router;
  readonly theme: ThemeChoice;
}

export interface Stores extends Lasting {
  readonly api: Api;
  readonly connect: Connect;
  readonly library: Library;
  readonly notices: Notices;
  readonly operated: Operated;
  readonly alerts: Alerts;
  readonly circumstances: Gathered;
  /** Closes every connection, and asks for nothing more. */
  readonly close: () => void;
}

export function makeLasting(asked: Api = api): Lasting {
  return { identity: new Identity(asked), router: new Router(), theme: new ThemeChoice() };
}

/** New stores, that ask the server through `asked`, listen to the streams of `open` and stop rigs by `line`. */
export function makeStores(
  lasting: Lasting,
  asked: Api = api,
  open: Connect = connect,
  line: OpenStopLine = openStopLine,
): Stores {
  const { identity } = lasting;
  const watched = { api: watchedApi(asked, identity), connect: watchedConnect(open, identity) };
  const library = new Library(watched.api);
  const notices = new Notices();
  const operated = new Operated(watched.api, notices, watched.connect, watchedLine(line, identity), identity);
  return {
    ...lasting,
    ...watched,
    library,
    notices,
    operated,
    alerts: new Alerts(),
    circumstances: new Gathered(operated, library, identity),
    close: () => {
      operated.close();
      operated.stops.close();
      library.close();
    },
  };
}

const [get, give] = createContext<Stores>();

/** The stores of the console that a component is part of; asked for as it is made. */
export const stores = get;
/** Gives stores to a component's children. */
export const giveStores = give;
