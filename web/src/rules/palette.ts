/** What the palette offers: pages, rigs and commands by name, each with whether it may be done now and why not. */
import type { CommandName } from "../contract/types";
import { shownCommands, verdict, type Circumstances, type Verdict } from "./commands";
import type { Page } from "./router";

export type Deed =
  | { kind: "page"; page: Page }
  | { kind: "rig"; rig: string }
  | { kind: "command"; command: CommandName }
  | { kind: "own"; own: "theme" | "keys" | "alerts" | "take" | "release" };

export interface PaletteEntry {
  label: string;
  group: "Page" | "Rig" | "Command" | "Console";
  deed: Deed;
  may: Verdict;
  /** It may set the rig in motion: asked about first, for a palette is typed in fast. */
  asks: boolean;
}

export const PAGE_LABELS: Record<Page, string> = {
  operate: "Operate",
  trajectories: "Flights",
  plans: "Plans",
  compare: "Compare",
  runs: "Runs",
  alarms: "Alarms",
  rigs: "Rigs",
  people: "People",
  account: "Account",
};

const YES: Verdict = { enabled: true };

interface Offered {
  pages: readonly Page[];
  rigs: readonly string[];
  live: boolean;
  now: Circumstances;
  /** Whether control may be taken. */
  take: Verdict;
}

export function paletteOf({ pages, rigs, live, now, take }: Offered): PaletteEntry[] {
  const commands = shownCommands(live, now.unacknowledged).map(({ name, label, motion }) => ({
    label,
    group: "Command" as const,
    deed: { kind: "command" as const, command: name },
    may: verdict(name, now),
    asks: motion && name !== "move",
  }));
  const stops = (["stop", "estop"] as const).map((command) => ({
    label: command === "stop" ? "Stop" : "E-stop",
    group: "Command" as const,
    deed: { kind: "command" as const, command },
    may: YES,
    asks: false,
  }));
  const own = (label: string, what: Extract<Deed, { kind: "own" }>["own"], may = YES): PaletteEntry => ({
    label,
    group: "Console",
    deed: { kind: "own", own: what },
    may,
    asks: false,
  });
  return [
    ...pages.map((page) => ({
      label: PAGE_LABELS[page],
      group: "Page" as const,
      deed: { kind: "page" as const, page },
      may: YES,
      asks: false,
    })),
    ...stops,
    now.leased ? own("Release control", "release") : own("Take control", "take", take),
    ...commands,
    ...rigs.map((rig) => ({
      label: `Operate ${rig}`,
      group: "Rig" as const,
      deed: { kind: "rig" as const, rig },
      may: YES,
      asks: false,
    })),
    own("Light or dark theme", "theme"),
    own("Sound and notification for alarms", "alerts"),
    own("The keys", "keys"),
  ];
}

/** Those whose name has every word of what is typed, the ones that begin with it first. */
export function matching(entries: readonly PaletteEntry[], typed: string): PaletteEntry[] {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  const found = entries.filter(({ label, group }) => {
    const text = `${label} ${group}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
  const first = words.join(" ");
  const begins = ({ label }: PaletteEntry): number => (label.toLowerCase().startsWith(first) ? 0 : 1);
  return found.sort((a, b) => begins(a) - begins(b));
}
