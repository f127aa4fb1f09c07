import { expect, it } from "vitest";
import type { Page } from "../net/request";
import { Pages } from "./pages.svelte";

const page = (rows: string, next: string | null): Page<string> => ({ rows: rows.split(""), next });

it("reads page after page, and the newest anew without losing the others", async () => {
  const answers: Record<string, Page<string>> = { "": page("dc", "c"), c: page("ba", null) };
  const list = new Pages<string>(
    (before) => Promise.resolve(answers[before ?? ""] ?? page("", null)),
    (row) => row,
  );
  expect(list.rows).toBeNull();
  await list.refresh();
  await list.more();
  expect([list.rows, list.next]).toEqual([["d", "c", "b", "a"], null]);
  answers[""] = page("edc", "c");
  await list.refresh();
  expect(list.rows).toEqual(["e", "d", "c", "b", "a"]);
  list.drop("d");
  list.put("b");
  expect(list.rows).toEqual(["e", "c", "b", "a"]);
});

it("of two reads the one asked for last counts, and a failure is said until it is over", async () => {
  const answers: ((page: Page<string>) => void)[] = [];
  const list = new Pages<string>(
    () => new Promise((resolve) => answers.push(resolve)),
    (row) => row,
  );
  const reads = [list.refresh(), list.refresh()];
  answers[1]?.(page("b", null));
  answers[0]?.(page("a", null));
  await Promise.all(reads);
  expect(list.rows).toEqual(["b"]);
  let down = true;
  const failing = new Pages<string>(
    () => (down ? Promise.reject(new Error("down")) : Promise.resolve(page("a", null))),
    (row) => row,
  );
  await failing.refresh();
  expect([failing.problem, failing.rows, failing.reading]).toEqual(["down", null, false]);
  down = false;
  await failing.restart();
  expect([failing.problem, failing.rows]).toEqual([null, ["a"]]);
});
