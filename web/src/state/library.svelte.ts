/** What the server keeps: rigs, trajectories, plans, methods, runs. Read when asked for, plans also while one is solved. */
import { api, messageOf, upload } from "../adapter/api";
import type { Health, Method, Plan, Rig, Run, Trajectory } from "../contract/types";

const POLL_MS = 250;
const UNFINISHED = new Set(["queued", "running"]);

export const unfinished = (plan: Plan): boolean => UNFINISHED.has(plan.status);

class Library {
  rigs: Rig[] = $state.raw([]);
  trajectories: Trajectory[] = $state.raw([]);
  plans: Plan[] = $state.raw([]);
  methods: Method[] = $state.raw([]);
  /** Null until first read: a long record takes a while to be summed up. */
  runs: Run[] | null = $state.raw(null);
  health: Health | null = $state.raw(null);
  problem: string | null = $state(null);
  /** Flight and plan the operator works with. */
  trajectory: string | null = $state(null);
  plan: string | null = $state(null);
  uploading: { name: string; fraction: number } | null = $state(null);

  #polling = false;

  readonly chosenTrajectory = $derived(this.trajectories.find(({ sha256 }) => sha256 === this.trajectory) ?? null);
  readonly chosenPlan = $derived(this.plans.find(({ id }) => id === this.plan) ?? null);

  /** Reads everything a page may show; a part that fails says so and leaves the others. */
  async refresh(): Promise<void> {
    this.problem = null;
    await Promise.all([
      this.#read(async () => (this.rigs = await api.rigs())),
      this.#read(async () => (this.methods = await api.methods())),
      this.#read(async () => (this.health = await api.health())),
      this.refreshTrajectories(),
      this.refreshPlans(),
      this.refreshRuns(),
    ]);
  }

  refreshRigs = (): Promise<void> => this.#read(async () => (this.rigs = await api.rigs()));
  refreshTrajectories = (): Promise<void> => this.#read(async () => (this.trajectories = await api.trajectories()));
  refreshRuns = (): Promise<void> => this.#read(async () => (this.runs = await api.runs()));

  async refreshPlans(): Promise<void> {
    await this.#read(async () => (this.plans = await api.plans()));
    if (this.plans.some(unfinished)) void this.#poll();
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
    this.#put(plan);
    this.plan = plan.id;
    void this.#poll();
    return plan;
  }

  async cancelPlan(id: string): Promise<void> {
    await api.cancelPlan(id);
    await this.refreshPlans();
  }

  async #poll(): Promise<void> {
    if (this.#polling) return;
    this.#polling = true;
    try {
      while (this.plans.some(unfinished)) {
        await new Promise((resolve) => setTimeout(resolve, POLL_MS));
        for (const { id } of this.plans.filter(unfinished)) this.#put(await api.plan(id));
      }
    } catch (error) {
      this.problem = messageOf(error);
    } finally {
      this.#polling = false;
    }
  }

  #put(plan: Plan): void {
    const others = this.plans.filter(({ id }) => id !== plan.id);
    this.plans = this.plans.length === others.length ? [plan, ...others] : this.plans.map((p) => (p.id === plan.id ? plan : p));
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
