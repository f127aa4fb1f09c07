/** What the server keeps: rigs, trajectories, methods, runs, and the jobs: plans and comparisons. */
import { api, messageOf, upload } from "../adapter/api";
import type { Comparison, Health, Method, Plan, RemedyKind, Rig, Run, Trajectory } from "../contract/types";
import { Jobs } from "./jobs.svelte";

class Library {
  rigs: Rig[] = $state.raw([]);
  trajectories: Trajectory[] = $state.raw([]);
  methods: Method[] = $state.raw([]);
  /** Null until first read: a long record takes a while to be summed up. */
  runs: Run[] | null = $state.raw(null);
  health: Health | null = $state.raw(null);
  problem: string | null = $state(null);
  /** Flight and plan the operator works with. */
  trajectory: string | null = $state(null);
  plan: string | null = $state(null);
  uploading: { name: string; fraction: number } | null = $state(null);

  readonly #plans = new Jobs<Plan>(api.plans, api.plan);
  readonly comparisons = new Jobs<Comparison>(api.comparisons, api.comparison);

  readonly plans = $derived(this.#plans.all);
  readonly chosenTrajectory = $derived(this.trajectories.find(({ sha256 }) => sha256 === this.trajectory) ?? null);
  readonly chosenPlan = $derived(this.plans.find(({ id }) => id === this.plan) ?? null);

  /** Reads what every page needs; a part that fails says so and leaves the others. */
  async refresh(): Promise<void> {
    this.problem = null;
    await Promise.all([
      this.#read(async () => (this.rigs = await api.rigs())),
      this.#read(async () => (this.methods = await api.methods())),
      this.#read(async () => (this.health = await api.health())),
      this.refreshTrajectories(),
      this.refreshPlans(),
    ]);
  }

  refreshRigs = (): Promise<void> => this.#read(async () => (this.rigs = await api.rigs()));
  refreshTrajectories = (): Promise<void> => this.#read(async () => (this.trajectories = await api.trajectories()));
  refreshRuns = (): Promise<void> => this.#read(async () => (this.runs = await api.runs()));

  async refreshPlans(): Promise<void> {
    await this.#plans.refresh();
    this.problem ??= this.#plans.problem;
  }

  async upload(file: File, convention: string): Promise<Trajectory> {
    this.uploading = { name: file.name, fraction: 0 };
    try {
      const stored = await upload(file, convention, (fraction) => (this.uploading = { name: file.name, fraction }));
      await this.refreshTrajectories();
      this.trajectory = stored.sha256;
      this.plan = null;
      return stored;
    } finally {
      this.uploading = null;
    }
  }

  async createPlan(trajectory: string, rig: string, method: string): Promise<Plan> {
    const plan = await api.createPlan(trajectory, rig, method);
    this.#plans.put(plan);
    this.plan = plan.id;
    return plan;
  }

  /** Searches a remedy: a plan of its own, which is not what the operator works with before it is chosen. */
  async createRemedy(plan: string, kind: RemedyKind): Promise<void> {
    this.#plans.put(await api.createRemedy(plan, kind));
  }

  async cancelPlan(id: string): Promise<void> {
    await api.cancelPlan(id);
    await this.refreshPlans();
  }

  async compare(trajectory: string, rig: string, methods: string[]): Promise<Comparison> {
    const comparison = await api.createComparison(trajectory, rig, methods);
    this.comparisons.put(comparison);
    return comparison;
  }

  /** Cancels one that is under way; removes one that is not. */
  async removeComparison(id: string): Promise<void> {
    await api.removeComparison(id);
    await this.comparisons.refresh();
  }

  async #read(read: () => Promise<unknown>): Promise<void> {
    try {
      await read();
    } catch (error) {
      this.problem = messageOf(error);
    }
  }
}

export const library = new Library();
