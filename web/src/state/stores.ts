/** The console's stores: made once, at the root, and given to every component by context. */
import { createContext } from "svelte";
import { api, type Api } from "../net/api";
import { openStopLine, type OpenStopLine } from "../net/stopChannel";
import { connect, type Connect } from "../net/stream";
import { Gathered } from "./circumstances.svelte";
import { Library } from "./library.svelte";
import { Notices } from "./notices.svelte";
import { Operated } from "./rig.svelte";
import { Router } from "./router.svelte";
import { ThemeChoice } from "./theme.svelte";

export interface Stores {
  readonly api: Api;
  readonly connect: Connect;
  readonly library: Library;
  readonly notices: Notices;
  readonly operated: Operated;
  readonly circumstances: Gathered;
  readonly router: Router;
  readonly theme: ThemeChoice;
}

/** New stores, that ask the server through `asked`, listen to the streams of `open` and stop rigs by `line`. */
export function makeStores(asked: Api = api, open: Connect = connect, line: OpenStopLine = openStopLine): Stores {
  const library = new Library(asked);
  const notices = new Notices();
  const operated = new Operated(asked, notices, open, line);
  const circumstances = new Gathered(operated, library);
  return {
    api: asked,
    connect: open,
    library,
    notices,
    operated,
    circumstances,
    router: new Router(),
    theme: new ThemeChoice(),
  };
}

const [get, give] = createContext<Stores>();

/** The stores of the console that a component is part of; asked for as it is made. */
export const stores = get;
/** Gives stores to a component's children. */
export const giveStores = give;
