/** The rig the console operates: its stream, its history, and the commands to it. */
import type { ArgsOf, CommandName } from "../contract/types";
import type { Api } from "../net/api";
import { messageOf } from "../net/errors";
import { History } from "../net/history";
import { NO_LINK, reduce, type Link, type LinkEvent } from "../net/link";
import type { OpenStopLine } from "../net/stopChannel";
import type { Connect, Connection } from "../net/stream";
import { sampleAt, type Batch, type Sample } from "../net/telemetry";
import type { TimeAxis } from "../rules/axis";
import { dataAgeMs, freshness, looksStale, type Freshness } from "../rules/freshness";
import type { Feed } from "./feed";
import { RigLease } from "./lease.svelte";
import type { Identity } from "./identity.svelte";
import type { Notices } from "./notices.svelte";
import { Stops } from "./stops.svelte";

/** Thirty a second, for a minute. */
const HISTORY = 1800;
const RENEW_MS = 2000;
const CLOCK_MS = 100;

export class Operated implements Feed {
  name: string | null = $state(null);
  link: Link = $state.raw(NO_LINK);
  latest: Sample | null = $state.raw(null);
  /** Grows with every frame: what plots wait for. */
  frames = $state(0);
  /** Age of the data and what it comes to, looked at ten times a second and at every change of the link. */
  ageMs: number | null = $state(null);
  freshness: Freshness = $state("stale");
  busy = $state(false);
  /** What the live source proves itself by that was loaded here; told once, so gone with the page. */
  liveKey: string | null = $state(null);
  history = new History(HISTORY);

  readonly session = $derived(this.link.session);
  readonly state = $derived(this.link.session?.state ?? null);
  readonly alarms = $derived(this.link.session?.alarms ?? []);
  readonly waiting = $derived(this.alarms.filter(({ acknowledged_by }) => !acknowledged_by));
  readonly unacknowledged = $derived(this.waiting.length);

  readonly stale = $derived(looksStale(this.link, this.freshness));
  readonly #lastS = $derived(this.stale && this.ageMs !== null ? Math.floor(this.ageMs / 1000) : 0);
  readonly axis: TimeAxis = $derived({ kind: "age", ageS: this.#lastS });

  readonly lease: RigLease;
  readonly stops: Stops;

  #stream: Connection | null = null;
  #timers: number[] = [];

  constructor(
    private readonly api: Api,
    private readonly notices: Notices,
    private readonly connect: Connect,
    openStopLine: OpenStopLine,
    identity: Pick<Identity, "me">,
  ) {
    this.lease = new RigLease(
      api,
      notices,
      () => this.session,
      () => identity.me,
    );
    this.stops = new Stops(api, notices, () => this.name, openStopLine);
  }

  open(name: string): void {
    if (this.name === name) return;
    this.close();
    this.name = name;
    this.lease.of(name);
    const listener = { link: (event: LinkEvent) => this.#link(event), batch: (batch: Batch) => this.#batch(batch) };
    this.#stream = this.connect(this.api.streamUrl(name), listener);
    this.#timers = [
      window.setInterval(() => this.#look(), CLOCK_MS),
      window.setInterval(() => void this.lease.renew(), RENEW_MS),
    ];
  }

  close(): void {
    this.#stream?.close();
    this.#stream = null;
    for (const id of this.#timers) window.clearInterval(id);
    this.#timers = [];
    this.name = null;
    this.link = NO_LINK;
    this.latest = null;
    this.history = new History(HISTORY);
    this.lease.of(null);
    this.liveKey = null;
    this.notices.clear();
    this.#look();
  }

  /** Gives a command; tells whether it was taken. */
  async command<Name extends CommandName>(command: Name, args: ArgsOf<Name>): Promise<boolean> {
    if (this.name === null) return false;
    this.busy = true;
    try {
      const done = await this.api.command(this.name, command, args, this.lease.next());
      if ("live_key" in done && command === "load") this.liveKey = done.live_key ?? null;
      return true;
    } catch (error) {
      this.notices.say("problem", messageOf(error));
      return false;
    } finally {
      this.busy = false;
    }
  }

  /** Gives commands one after another, to the first that is refused; tells whether all were taken. */
  async inTurn(commands: readonly CommandName[], plan: string | null): Promise<boolean> {
    for (const name of commands) {
      const done = name === "load" ? await this.command("load", { plan }) : await this.command(name, {});
      if (!done) return false;
    }
    return true;
  }

  #link(event: LinkEvent): void {
    this.link = reduce(this.link, event);
    if (event.type !== "frame") this.#look();
    if (event.type !== "opened" && event.type !== "session") return;
    this.stops.observe(event.session.state);
    this.lease.observe(event.session.lease);
  }

  #look(): void {
    const now = performance.now();
    this.ageMs = dataAgeMs(this.link, now);
    this.freshness = freshness(this.link, now);
  }

  #batch(batch: Batch): void {
    for (let row = 0; row < batch.count; row++) this.history.push(sampleAt(batch, row));
    this.latest = sampleAt(batch, batch.count - 1);
    this.frames++;
  }
}
