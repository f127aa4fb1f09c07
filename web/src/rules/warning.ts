/** What the console warns of on every page: a lost connection, old data, lists that could not be read. */
import type { Link } from "../net/link";

/** Whether the connection is lost; the first attempt of a page that just opened is none. */
export function lost(link: Link): boolean {
  return link.phase === "closed" || (link.phase === "connecting" && (link.session !== null || link.attempt > 1));
}

/** `channel`: whether the stop channel is open, which is another connection, to another process. */
export function linkWarning(link: Link, stale: boolean, channel: boolean): string | null {
  if (lost(link)) {
    const stops = channel
      ? "Stop and E-stop are sent by their own channel, which is open; where one is not confirmed, use the hardware E-stop."
      : "Stop and E-stop cannot reach the rig from here: use the hardware E-stop.";
    return (
      `Connection lost, trying again: what is shown is the last known, not the rig now. ${stops} ` +
      "A rig whose operator or server stays silent holds, then brakes, by itself."
    );
  }
  if (!stale) return null;
  return (
    "Data is stale: what is shown is the last known, not the rig now. Motion is disabled. Stop and E-stop are sent; " +
    "where one is not confirmed, the console says so."
  );
}

/** `known`: whether the console has a rig to speak to. */
export function listsWarning(problem: string | null, known: boolean): string | null {
  if (problem === null) return null;
  const said = `Not up to date: ${problem}. Trying again.`;
  return known
    ? said
    : `${said} No rig is known yet: Stop and E-stop cannot be sent from here, use the hardware E-stop.`;
}
