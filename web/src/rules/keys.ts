/** The keyboard: Space holds and resumes, Esc stops. */

export interface Key {
  key: string;
  repeat: boolean;
  /** The focus is where text is typed. */
  typing: boolean;
  /** Ctrl, Alt or Meta is down. */
  modified: boolean;
}

/** The command a key stands for in a state, or null. Esc stops even while typing; Space then is a space. */
export function commandOfKey(key: Key, state: string | null): "hold" | "resume" | "stop" | null {
  if (key.repeat || key.modified) return null;
  if (key.key === "Escape") return "stop";
  if (key.key !== " " || key.typing) return null;
  if (state === "running") return "hold";
  if (state === "held") return "resume";
  return null;
}
