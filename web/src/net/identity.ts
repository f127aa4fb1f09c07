/** Who this tab is to the server. */
import type { paths } from "../contract/schema";

type Stop = paths["/api/v1/rigs/{rig}/stop"]["post"];

/** The header that says it. */
export const CLIENT_HEADER: keyof NonNullable<Stop["parameters"]["header"]> = "x-fullpose-client";

const KEY = "fullpose.me";

/** The name this tab commands under while the server knows no users: the lease is one tab's, not one machine's. */
export function me(): string {
  let name = sessionStorage.getItem(KEY);
  if (name === null) {
    name = `console-${(crypto.getRandomValues(new Uint32Array(1))[0] ?? 0).toString(36).slice(0, 4)}`;
    sessionStorage.setItem(KEY, name);
  }
  return name;
}
