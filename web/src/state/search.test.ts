import { expect, it } from "vitest";
import type { Searched } from "../contract/types";
import type { Page } from "../net/request";
import { Search } from "./search.svelte";

interface Asked {
  wanted: Searched;
  before: string | null;
  answer: (rows: string, next?: string | null) => void;
}

function searching(): { search: Search<string>; asked: Asked[] } {
  const asked: Asked[] = [];
  const ask = (before: string | null, wanted: Searched): Promise<Page<string>> =>
    new Promise((resolve) =>
      asked.push({ wanted, before, answer: (rows, next = null) => resolve({ rows: rows.split(""), next }) }),
    );
  return { search: new Search(ask, (row) => row, 0), asked };
}

it("asks for the words once no more are typed, and for the tag with them", async () => {
  const { search, asked } = searching();
  search.type("lo");
  search.type(" loop ");
  await expect.poll(() => asked.length).toBe(1);
  expect(asked[0]?.wanted).toEqual({ q: "loop", tag: null });
  const narrowed = search.narrow("north");
  expect(asked[1]?.wanted).toEqual({ q: "loop", tag: "north" });
  asked[1]?.answer("ab", "b");
  await narrowed;
  expect(search.found?.rows).toEqual(["a", "b"]);
  asked[0]?.answer("c"); // of what is asked for no longer
  await Promise.resolve();
  expect(search.found?.rows).toEqual(["a", "b"]);
  const more = search.found?.more();
  expect(asked[2]).toMatchObject({ before: "b", wanted: { q: "loop", tag: "north" } });
  asked[2]?.answer("c");
  await more;
  search.drop("a");
  expect(search.found?.rows).toEqual(["b", "c"]);
});

it("is over where nothing is searched for, and asks for nothing then", async () => {
  const { search, asked } = searching();
  const narrowed = search.narrow("north");
  asked[0]?.answer("a");
  await narrowed;
  await search.narrow(null);
  expect([search.found, asked.length]).toEqual([null, 1]);
  search.type("   ");
  await search.refresh();
  search.put("a");
  expect([search.found, asked.length]).toEqual([null, 1]);
});

it("says what is wrong with a search", async () => {
  const search = new Search<string>(
    () => Promise.reject(new Error("too many words")),
    (row) => row,
  );
  await search.narrow("x");
  expect(search.found).toMatchObject({ problem: "too many words", rows: null });
});
