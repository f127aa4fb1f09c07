import { expect, it } from "vitest";
import { ApiError } from "../net/errors";
import { Jobs, type Job } from "./jobs.svelte";

/** A server's jobs in memory, and waits that a test lets pass. */
class World {
  answers: (Job | Error)[] = [];
  asked = 0;
  listed: Job[] | Promise<Job[]> = [];
  waits: number[] = [];
  #next: (() => void) | null = null;

  readonly jobs = new Jobs<Job>(
    async () => ({ rows: await this.listed, next: null }),
    () => {
      this.asked++;
      const answer = this.answers.shift() ?? new Error("asked once too often");
      return answer instanceof Error ? Promise.reject(answer) : Promise.resolve(answer);
    },
    (ms) => new Promise((resolve) => ((this.#next = resolve), this.waits.push(ms))),
  );

  /** Lets one wait pass, and all that comes of it. */
  async pass(): Promise<void> {
    this.#next?.();
    this.#next = null;
    await new Promise((resolve) => setTimeout(resolve));
  }
}

const running = { id: "a", status: "running" };
const done = { id: "a", status: "done" };
const silence = (): ApiError => new ApiError(0, "The server does not answer");

it("a job is followed through failures of the network, ever more slowly, and these are said until they are over", async () => {
  const world = new World();
  world.answers = [silence(), silence(), new ApiError(503, "busy"), running, done];
  world.jobs.put(running);
  await world.pass();
  expect(world.jobs.problem).toBe("The server does not answer");
  await world.pass();
  await world.pass();
  expect(world.jobs.problem).toBe("busy");
  expect(world.waits[3]).toBeGreaterThan(world.waits[0] ?? Infinity);
  await world.pass();
  expect(world.jobs.problem).toBeNull();
  expect(world.waits[4]).toBe(world.waits[0]);
  await world.pass();
  expect(world.jobs.all).toEqual([done]);
  expect(world.asked).toBe(5);
  await world.pass();
  expect(world.asked).toBe(5);
});

it("a job that the server no longer has is followed no longer, the others are", async () => {
  const world = new World();
  const other = { id: "b", status: "queued" };
  world.answers = [new ApiError(404, "no such plan"), other, { ...other, status: "done" }];
  world.listed = [running, other];
  await world.jobs.refresh();
  await world.pass();
  expect(world.jobs.all).toEqual([other]);
  expect(world.jobs.problem).toBeNull();
  await world.pass();
  expect(world.jobs.all).toEqual([{ id: "b", status: "done" }]);
});

it("a list that was asked for before a job was made does not take it away", async () => {
  const world = new World();
  let answer: (jobs: Job[]) => void = () => undefined;
  world.listed = new Promise((resolve) => (answer = resolve));
  const refreshed = world.jobs.refresh();
  world.jobs.put(done);
  world.listed = [done];
  answer([]);
  await refreshed;
  expect(world.jobs.all).toEqual([done]);
});

it("a list that cannot be read keeps what was there, and says so", async () => {
  const world = new World();
  world.jobs.put(done);
  world.listed = Promise.reject(silence());
  await world.jobs.refresh();
  expect(world.jobs.all).toEqual([done]);
  expect(world.jobs.problem).toBe("The server does not answer");
});
