/** The curves of a run: what there is, the window that is looked at, and the one of what it is compared with. */
import type { CurveEvent, Curves } from "../contract/types";
import type { Api } from "../net/api";
import { decodeCurves, type CurvesWindow } from "../net/curves";
import { messageOf } from "../net/errors";
import { Latest } from "../net/latest";
import type { Range } from "../rules/limits";
import { held } from "../rules/zoom";

const AGAIN_MS = 300;
/** So many buckets however wide the screen: a line touches two values in each. */
const WIDTH = 1200;

export class RunCurves {
  about: Curves | null = $state.raw(null);
  /** Of what the run is compared with; null where it is not, or not yet. */
  difference: Curves["against"] = $state.raw(null);
  window: CurvesWindow | null = $state.raw(null);
  reference: CurvesWindow | null = $state.raw(null);
  /** What part of the work is done, where it is being done. */
  progress: number | null = $state(null);
  problem: string | null = $state(null);
  /** `run:ID` or `plan:ID`; null: the run alone. */
  against: string | null = $state(null);
  view: Range = $state.raw([0, 0]);

  readonly all: Range = $derived([0, Math.max(this.about?.duration_s ?? 0, 1e-6)]);
  readonly events: readonly CurveEvent[] = $derived(this.about?.events ?? []);
  readonly zoomed = $derived(this.view[0] > this.all[0] || this.view[1] < this.all[1]);

  #closed = false;
  readonly #windows: Latest<Range>;

  constructor(
    private readonly api: Pick<Api, "curves" | "curvesWindow">,
    private readonly run: string,
  ) {
    this.#windows = new Latest(
      (view) => this.#read(view),
      (error) => (this.problem = messageOf(error)),
    );
    void this.#open();
  }

  close(): void {
    this.#closed = true;
  }

  /** Looks at another stretch of the run. */
  show = (view: Range): void => {
    this.view = held(view, this.all);
    this.#windows.put(this.view);
  };

  reset = (): void => this.show(this.all);

  /** Compares with another run or a plan; null: with nothing. */
  async compare(against: string | null): Promise<void> {
    this.against = against;
    this.difference = null;
    this.reference = null;
    this.problem = null;
    if (against === null) return;
    const found = await this.#ready(against);
    if (found === null || this.against !== against) return;
    this.difference = found.against;
    this.#windows.put(this.view);
  }

  async #open(): Promise<void> {
    const found = await this.#ready(null);
    if (found === null) return;
    this.about = found;
    this.reset();
  }

  /** Asks until they are made; null where that came to nothing, or something else is compared with by now. */
  async #ready(against: string | null): Promise<Curves | null> {
    try {
      for (;;) {
        const found = await this.api.curves(this.run, against);
        if (this.#closed || (against !== null && this.against !== against)) return null;
        this.progress = found.ready ? null : found.progress;
        if (found.ready) return found;
        await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
      }
    } catch (error) {
      this.problem = messageOf(error);
      this.progress = null;
      return null;
    }
  }

  async #read([from, to]: Range): Promise<void> {
    const { about, difference, against } = this;
    if (about === null || about.samples === 0) return;
    const [own, other] = await Promise.all([
      this.api.curvesWindow(this.run, from, to, WIDTH),
      difference && against ? this.api.curvesWindow(this.run, from, to, WIDTH, against) : null,
    ]);
    this.window = decodeCurves(own, about.columns);
    if (this.against === against) this.reference = other && difference ? decodeCurves(other, difference.columns) : null;
    this.problem = null;
  }
}
