import { expect, it } from "vitest";
import { Latest } from "./latest";

it("sends one at a time, and of those that came meanwhile only the last", async () => {
  const sent: number[] = [];
  let answer = (): void => undefined;
  const latest = new Latest<number>(
    (value) => {
      sent.push(value);
      return new Promise<void>((resolve) => (answer = resolve));
    },
    () => undefined,
  );
  for (const value of [1, 2, 3]) latest.put(value);
  expect(sent).toEqual([1]);
  answer();
  await new Promise((resolve) => setTimeout(resolve));
  expect(sent).toEqual([1, 3]);
});

it("goes on after a failure, and tells it", async () => {
  const failures: unknown[] = [];
  const sent: number[] = [];
  const latest = new Latest<number>(
    (value) => {
      sent.push(value);
      return value === 1 ? Promise.reject(new Error("no")) : Promise.resolve();
    },
    (error) => failures.push(error),
  );
  latest.put(1);
  latest.put(2);
  await new Promise((resolve) => setTimeout(resolve));
  expect(sent).toEqual([1, 2]);
  expect(failures).toHaveLength(1);
});
