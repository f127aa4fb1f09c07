import { expect, it } from "vitest";
import type { Page } from "../net/request";
import { extended, NOTHING, renewed } from "./pages";

const page = (rows: string, next: string | null): Page<string> => ({ rows: rows.split(""), next });
const own = (row: string): string => row;

it("a newest page that is read again keeps what was read after it", () => {
  expect(renewed(page("fed", "d"), page("edcba", null), own)).toEqual(page("fedcba", null));
  expect(renewed(page("fed", "d"), page("edc", "c"), own)).toEqual(page("fedc", "c"));
});

it("rows that came in such number that a page may be missing between are read again from the top", () => {
  expect(renewed(page("zyx", "x"), page("cba", null), own)).toEqual(page("zyx", "x"));
  expect(renewed(page("dcb", "b"), page("cb", null), own)).toEqual(page("dcb", "b"));
});

it("what was removed from a list of one page is gone, and an empty list is empty", () => {
  expect(renewed(page("ca", null), page("cba", null), own)).toEqual(page("ca", null));
  expect(renewed(NOTHING, page("a", null), own)).toEqual(NOTHING);
});

it("an older page follows, and no row is there twice", () => {
  expect(extended(page("dc", "c"), page("cba", null), own)).toEqual(page("dcba", null));
});
