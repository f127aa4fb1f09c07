/** A file that is dropped on the page: wherever it falls, the browser must not leave the console for it. */
import type { Page } from "./router";

const TAKING: readonly Page[] = ["operate", "trajectories"];

/** Whether a page takes flights. */
export function takesFlights(page: Page): boolean {
  return TAKING.includes(page);
}

/** Why files that were given are not taken, or null. `sending`: name of the one under way. */
export function refusalOf(
  files: readonly { name: string; size: number }[],
  sending: string | null,
  mostBytes: number,
): string | null {
  const [file, ...more] = files;
  if (!file) return "Nothing was taken: no file was dropped";
  if (sending !== null) return `${file.name} was not taken: ${sending} is still being sent`;
  if (more.length > 0) return `Nothing was taken: ${files.length} files at once, one is expected`;
  if (file.size > mostBytes) return `${file.name} has ${mega(file.size)} MB, the server takes ${mega(mostBytes)} MB`;
  return null;
}

const mega = (bytes: number): string => (bytes / 1e6).toFixed(0);

/** How far an upload is: what has been sent in full is still to be read by the server. */
export function sendingText(fraction: number): string {
  return fraction < 1 ? `${Math.floor(100 * fraction)} % sent` : "Sent, checking…";
}
