/** What the server keeps: rigs, trajectories, methods, runs, and the jobs: plans and comparisons. */
import type {
  Comparison,
  Health,
  HowToRead,
  LabelsIn,
  Method,
  Plan,
  RemedyKind,
  Rig,
  Run,
  Trajectory,
} from "../contract/types";
import type { Api } from "../net/api";
import { messageOf } from "../net/errors";
import { backoffMs } from "../net/keptSocket";
import type { Chosen, Loaded } from "../rules/choice";
import { Jobs } from "./jobs.svelte";
import { Pages } from "./pages.svelte";
import { Search } from "./search.svelte";

export class Library {
  rigs: Rig[] = $state.raw([]);
  methods: Method[] = $state.raw([]);
  health: Health | null = $state.raw(null);
  /** Flight and plan the operator works with. */
  trajectory: string | null = $state(null);
  plan: string | null = $state(null);
  /** A live source is what is to be flown, and no plan. */
  live = $state(false);
  uploading: { name: string; fraction: number } | null = $state(null);

  readonly flights: Pages<Trajectory>;
  readonly records: Pages<Run>;
  readonly planning: Jobs<Plan>;
  readonly comparisons: Jobs<Comparison>;
  readonly searches: {
    readonly flights: Search<Trajectory>;
    readonly plans: Search<Plan>;
    readonly runs: Search<Run>;
  };

  /** What could not be read, by what it is. */
  #problems: Readonly<Record<string, string>> = $state.raw({});
  readonly #reads: Record<string, number> = {};
  #retry = 0;
  #closed = false;
  #misses = 0;

  /** Why what is shown may not be what the server has; null where all of it was read. */
  readonly problem: string | null;
  readonly trajectories: readonly Trajectory[];
  /** Null until first read: a long record takes a while to be summed up. */
  readonly runs: readonly Run[] | null;
  readonly plans: readonly Plan[];
  readonly chosenTrajectory: Trajectory | null;
  readonly chosenPlan: Plan | null;
  readonly chosen: Chosen;
  /** The loaded plan that was last made the chosen one. */
  #followed: string | null = null;
  #picked = false;

  constructor(private readonly api: Api) {
    const plans = new Jobs<Plan>(api.plans, api.plan);
    const comparisons = new Jobs<Comparison>(api.comparisons, api.comparison);
    const shaOf = ({ sha256 }: Trajectory): string => sha256;
    const idOf = ({ id }: { id: string }): string => id;
    const flights = new Pages<Trajectory>(api.trajectories, shaOf);
    const records = new Pages<Run>(api.runs, idOf);
    this.searches = {
      flights: new Search<Trajectory>(api.trajectories, shaOf),
      plans: new Search<Plan>(api.plans, idOf),
      runs: new Search<Run>(api.runs, idOf),
    };
    this.planning = plans;
    this.flights = flights;
    this.records = records;
    this.comparisons = comparisons;
    this.plans = $derived(plans.all);
    this.trajectories = $derived(flights.rows ?? []);
    this.runs = $derived(records.rows);
    this.problem = $derived(
      Object.values(this.#problems)[0] ?? flights.problem ?? records.problem ?? plans.problem ?? comparisons.problem,
    );
    this.chosenTrajectory = $derived(this.trajectories.find(({ sha256 }) => sha256 === this.trajectory) ?? null);
    this.chosenPlan = $derived(plans.all.find(({ id }) => id === this.plan) ?? null);
    this.chosen = $derived({ live: this.live, flight: this.trajectory, plan: this.plan });
  }

  /** Reads what every page needs; a part that fails says so, leaves the others, and all is tried again until it is read. */
  async refresh(): Promise<void> {
    clearTimeout(this.#retry);
    await Promise.all([
      this.refreshRigs(),
      this.#read("methods", this.api.methods, (methods) => (this.methods = methods)),
      this.refreshHealth(),
      this.flights.refresh(),
      this.planning.refresh(),
      ...(this.records.problem === null ? [] : [this.records.refresh()]),
      ...(this.comparisons.problem === null ? [] : [this.comparisons.refresh()]),
    ]);
    this.#misses = this.problem === null ? 0 : this.#misses + 1;
    clearTimeout(this.#retry);
    if (this.#misses > 0 && !this.#closed)
      this.#retry = window.setTimeout(() => void this.refresh(), backoffMs(this.#misses, Math.random()));
  }

  /** Asks for nothing more by itself. */
  close(): void {
    this.#closed = true;
    clearTimeout(this.#retry);
    this.planning.close();
    this.comparisons.close();
  }

  refreshRigs = (): Promise<void> => this.#read("rigs", this.api.rigs, (rigs) => (this.rigs = rigs));
  refreshHealth = (): Promise<void> => this.#read("health", this.api.health, (health) => (this.health = health));

  /** What the operator works with from now on; `picked`: a person's choice, and no suggestion of ours. */
  chooseTrajectory(sha256: string | null, picked = true): void {
    this.#picked ||= picked;
    if (sha256 !== this.trajectory && this.chosenPlan?.trajectory !== sha256) this.plan = null;
    this.trajectory = sha256;
  }

  choosePlan(id: string | null, picked = true): void {
    this.#picked ||= picked;
    this.plan = id;
  }

  chooseLive(live: boolean): void {
    this.live = live;
  }

  /** What is newly loaded becomes what is chosen; what a person chose before the first is known stays. */
  async follow(loaded: Loaded): Promise<void> {
    const which = loaded === null ? null : loaded.live ? "live" : loaded.plan_id;
    const [first, known] = [this.#followed === null, this.#followed === which];
    if (which === null || known) return;
    this.#followed = which;
    if (first && this.#picked) return;
    this.live = which === "live";
    if (this.live) return;
    try {
      const plan = this.plans.find(({ id }) => id === which) ?? (await this.api.plan(which));
      if (this.#followed !== which) return;
      this.planning.put(plan);
      this.trajectory = plan.trajectory;
      this.plan = plan.id;
    } catch {
      this.#followed = null; // asked for again with the next word of the rig
    }
  }

  async deleteTrajectory(sha256: string): Promise<void> {
    await this.api.deleteTrajectory(sha256);
    if (this.trajectory === sha256) this.trajectory = null;
    this.flights.drop(sha256);
    this.searches.flights.drop(sha256);
    await this.flights.refresh();
  }

  async deleteRun(id: string): Promise<void> {
    await this.api.deleteRun(id);
    this.records.drop(id);
    this.searches.runs.drop(id);
    await this.records.refresh();
  }

  /** Keeps a run whatever its age, or no longer. */
  async pinRun(id: string, pinned: boolean): Promise<void> {
    await (pinned ? this.api.pinRun(id) : this.api.unpinRun(id));
    this.#takeRun(await this.api.run(id));
  }

  /** Puts tags and notes to a flight, a plan or a run. Raises what the request raises. */
  async labelTrajectory(sha256: string, labels: LabelsIn): Promise<void> {
    const flight = await this.api.labelTrajectory(sha256, labels);
    this.flights.put(flight);
    this.searches.flights.put(flight);
  }

  async labelPlan(id: string, labels: LabelsIn): Promise<void> {
    const plan = await this.api.labelPlan(id, labels);
    this.planning.put(plan);
    this.searches.plans.put(plan);
  }

  async labelRun(id: string, labels: LabelsIn): Promise<Run> {
    const run = await this.api.labelRun(id, labels);
    this.#takeRun(run);
    return run;
  }

  async upload(file: File, how: HowToRead): Promise<Trajectory> {
    this.uploading = { name: file.name, fraction: 0 };
    try {
      const stored = await this.api.upload(file, how, (fraction) => (this.uploading = { name: file.name, fraction }));
      await Promise.all([this.flights.refresh(), this.searches.flights.refresh()]);
      this.chooseTrajectory(stored.sha256);
      this.plan = null;
      return stored;
    } finally {
      this.uploading = null;
    }
  }

  async createPlan(trajectory: string, rig: string, method: string, toleranceDeg: number | null = null): Promise<Plan> {
    const plan = await this.api.createPlan(trajectory, rig, method, toleranceDeg);
    this.planning.put(plan);
    this.choosePlan(plan.id);
    return plan;
  }

  /** Searches a remedy: a plan of its own, which is not what the operator works with before it is chosen. */
  async createRemedy(plan: string, kind: RemedyKind): Promise<void> {
    this.planning.put(await this.api.createRemedy(plan, kind));
  }

  async cancelPlan(id: string): Promise<void> {
    await this.api.cancelPlan(id);
    await this.planning.refresh();
  }

  async compare(
    trajectory: string,
    rig: string,
    methods: string[],
    toleranceDeg: number | null = null,
  ): Promise<Comparison> {
    const comparison = await this.api.createComparison(trajectory, rig, methods, toleranceDeg);
    this.comparisons.put(comparison);
    return comparison;
  }

  /** Cancels one that is under way; removes one that is not. */
  async removeComparison(id: string): Promise<void> {
    await this.api.removeComparison(id);
    await this.comparisons.refresh();
  }

  #takeRun(run: Run): void {
    this.records.put(run);
    this.searches.runs.put(run);
  }

  /** Of two reads of one list the one asked for last counts, whichever is answered first. */
  async #read<T>(what: string, ask: () => Promise<T>, take: (answer: T) => void): Promise<void> {
    const turn = (this.#reads[what] ?? 0) + 1;
    this.#reads[what] = turn;
    try {
      const answer = await ask();
      if (this.#reads[what] !== turn) return;
      take(answer);
      const { [what]: _, ...others } = this.#problems;
      this.#problems = others;
    } catch (error) {
      if (this.#reads[what] === turn) this.#problems = { ...this.#problems, [what]: messageOf(error) };
    }
  }
}
