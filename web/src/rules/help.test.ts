/// <reference types="node" />
import { readFileSync } from "node:fs";
import { expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import { CONVENTIONS, methodHelp } from "./help";
import { ASIDE, PATH } from "./session";

const guide = readFileSync(new URL("../../../docs/guide/solver.md", import.meta.url), "utf8");
const rows = [...guide.matchAll(/^\| `(\w+)` \|.*\| (yes|no) \|$/gm)].map(([, name = "", keeps = ""]) => [name, keeps]);

it("every method of the guide has its sentence, that says of the limits what the guide does", () => {
  expect(rows.length).toBe(12);
  for (const [name = "", keeps] of rows)
    expect(methodHelp(name)).toMatch(keeps === "yes" ? /keeps the limits|inside the limits/ : /may pass the limits/);
});

it("every state and every convention has one", () => {
  expect(new Set([...PATH, ...ASIDE].map(({ name }) => name))).toEqual(new Set(contract.components.schemas.State.enum));
  for (const { meaning } of [...PATH, ...ASIDE]) expect(meaning).not.toBe("");
  for (const sentence of Object.values(CONVENTIONS)) expect(sentence).toMatch(/\.$/);
});
