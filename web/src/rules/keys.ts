/** The keyboard: Space holds, Esc stops. Nothing on it sets a rig in motion. */

export interface Key {
  key: string;
  repeat: boolean;
  /** Ctrl, Alt or Meta is down. */
  modified: boolean;
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
