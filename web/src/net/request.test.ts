import { expect, it } from "vitest";
import { cursorOf, pathTo, request, socketTo } from "./request";

it("fills a path in, whatever a name holds", () => {
  expect(pathTo("/api/v1/plans/{plan}", { plan: "a b/c" })).toBe("/api/v1/plans/a%20b%2Fc");
  expect(pathTo("/api/v1/runs/{run}/export", { run: "r" }, { format: "csv" })).toBe("/api/v1/runs/r/export?format=csv");
  expect(pathTo("/api/v1/runs", {})).toBe("/api/v1/runs");
});

it("does not compile what the contract does not know", () => {
  const soon = { withinMs: 1 };
  const refused = [
    // @ts-expect-error: no such path
    () => request("get", "/api/v1/plan", {}, soon),
    // @ts-expect-error: no such verb
    () => request("delete", "/api/v1/plans", {}, soon),
    // @ts-expect-error: no such name in the path
    () => request("get", "/api/v1/plans/{plan}", { id: "a" }, soon),
    // @ts-expect-error: no such query
    () => request("get", "/api/v1/plans/{plan}/samples", { plan: "a" }, { ...soon, query: { rows: 3 } }),
    // @ts-expect-error: not its body
    () => request("post", "/api/v1/plans", {}, { ...soon, body: { trajectory: 1 } }),
    // @ts-expect-error: not its answer
    async (): Promise<number> => request("get", "/api/v1/plans/{plan}", { plan: "a" }, soon),
    // @ts-expect-error: not a format of an export
    () => pathTo("/api/v1/runs/{run}/export", { run: "r" }, { format: "xml" }),
    // @ts-expect-error: no WebSocket
    () => socketTo("/api/v1/plans", {}),
  ];
  expect(refused).toHaveLength(8);
});

it("leaves out of a query what is not asked for, and finds where the next page begins", () => {
  expect(pathTo("/api/v1/alarms", {}, { rig: "a b", code: null, standing: false })).toBe(
    "/api/v1/alarms?rig=a+b&standing=false",
  );
  expect(cursorOf('</api/v1/alarms?before=1.5~a-1&limit=100>; rel="next"')).toBe("1.5~a-1");
  expect(cursorOf('</api/v1/alarms?limit=100>; rel="prev"')).toBeNull();
  expect(cursorOf(null)).toBeNull();
});
