/** The keyboard: Space holds, Esc stops. Nothing on it sets a rig in motion. */

export interface Key {
  key: string;
  repeat: boolean;
  /** Ctrl, Alt or Meta is down. */
  modified: boolean;
  /** Ctrl or Meta is down, and not Alt. */
  ctrl?: boolean;
  /** Where the focus is: in text that is typed, on a control that a key works, or on neither. */
  focus: "text" | "control" | "none";
}

/**
 * What a key stands for in a session state, or null. Esc stops whatever has the focus. Space holds what runs, unless text
 * is typed; else a control that has the focus keeps it, and a playback on the page (`playback`) starts and pauses.
 */
export function commandOfKey(key: Key, state: string | null, playback: boolean): "hold" | "stop" | "play" | null {
  if (key.repeat || key.modified) return null;
  if (key.key === "Escape") return "stop";
  if (key.key !== " " || key.focus === "text") return null;
  if (state === "running") return "hold";
  return playback && key.focus === "none" ? "play" : null;
}

/** What a key opens, or closes again: `?` the keys, unless text is typed, and Ctrl-K the palette, from everywhere. */
export function opensWith(key: Key): "keys" | "palette" | null {
  if (key.repeat) return null;
  if (key.ctrl === true && key.key.toLowerCase() === "k") return "palette";
  return key.key === "?" && !key.modified && key.focus !== "text" ? "keys" : null;
}

/** All keys, as the console tells them. */
export const KEYS: readonly { key: string; does: string }[] = [
  { key: "Esc", does: "Stop, on every page and in every state, while typing too. It also closes what is open." },
  { key: "Space", does: "Hold, on every page, while the rig runs. It never resumes." },
  { key: "Space, nothing running", does: "Play and pause a replay or a plan; press the button that has the focus." },
  { key: "Arrows, Home, End", does: "Move through the time of a replay or a plan; with Shift an arrow goes a second." },
  { key: "Ctrl K", does: "Pages and commands by name. It opens and closes them, and no rig is stopped by it." },
  { key: "?", does: "These keys." },
];
