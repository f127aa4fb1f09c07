// @vitest-environment happy-dom
import { beforeEach, expect, it } from "vitest";
import { Router } from "./router.svelte";

beforeEach(() => {
  sessionStorage.clear();
  history.replaceState(null, "", "/");
});

it("comes back from another site to where it was, once, and never away from an address", () => {
  const before = new Router();
  before.go("plans", "a b");
  before.keep();
  history.replaceState(null, "", "/");
  const after = new Router();
  after.comeBack();
  expect(after.route).toEqual({ page: "plans", item: "a b" });
  expect(location.pathname).toBe("/plans/a%20b");
  after.go("runs");
  after.comeBack();
  before.keep();
  after.comeBack();
  expect(location.pathname).toBe("/runs");
});
