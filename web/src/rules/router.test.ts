import { expect, it } from "vitest";
import { PAGES, pathOf, routeOf } from "./router";

it("paths and routes are each other's inverse", () => {
  for (const page of PAGES) {
    expect(routeOf(pathOf(page))).toEqual({ page, item: null });
    for (const item of ["vertical-4", "a b/c", "ünï"]) expect(routeOf(pathOf(page, item))).toEqual({ page, item });
  }
});

it("an unknown path is the operate page, without taking its parts for a rig", () => {
  expect(routeOf("/")).toEqual({ page: "operate", item: null });
  expect(routeOf("/admin/users")).toEqual({ page: "operate", item: null });
});
