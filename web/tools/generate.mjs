// Generates src/contract/schema.d.ts from ../docs/openapi.json; with --check, fails where the committed file differs.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import openapiTS, { astToString } from "openapi-typescript";

const source = new URL("../../docs/openapi.json", import.meta.url);
const target = new URL("../src/contract/schema.d.ts", import.meta.url);

/** What OpenAPI has no place for, as interfaces beside `paths`: the WebSockets, and the bits of a sample's flags. */
function extensions(document) {
  const type = ({ $ref }) => `components["schemas"]["${$ref.split("/").at(-1)}"]`;
  const lines = Object.entries(document["x-websockets"]).map(
    ([path, { sent, answered }]) => `    "${path}": { sent: ${type(sent)}; answered: ${type(answered)} };`,
  );
  const flags = Object.entries(document["x-telemetry-flags"]).map(([name, bit]) => `    ${name}: ${bit};`);
  return ["export interface sockets {", ...lines, "}", "export interface flags {", ...flags, "}", ""].join("\n");
}

const head = "// Generated from docs/openapi.json by `npm run generate`. Do not edit.\n\n";
const text =
  head +
  astToString(await openapiTS(source, { alphabetize: true })) +
  extensions(JSON.parse(readFileSync(source, "utf8")));

if (process.argv.includes("--check")) {
  const committed = existsSync(target) ? readFileSync(target, "utf8") : "";
  if (committed !== text) {
    console.error(`${fileURLToPath(target)} is behind docs/openapi.json: run \`npm run generate\` and commit it.`);
    process.exit(1);
  }
} else {
  writeFileSync(target, text);
}
