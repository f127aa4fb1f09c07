/** Numbers as the console writes them. A missing value is a dash, never a zero. */

export const MISSING = "–";
const MINUS = "−";

/** A code or a name of the contract as people read it, "following error". */
export const inWords = (code: string): string => code.replaceAll("_", " ");

/** Fixed decimals with a real minus sign; widths stay equal under tabular numerals. */
export function fixed(value: number | null | undefined, digits: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return MISSING;
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", MINUS);
}

/**
 * A figure that may be of any size, as an error is: of everyday size, from a thousandth to 100 000, in decimals, and
 * else as a power of ten, "3.2e−13". An exact zero says so.
 */
export function scientific(value: number | null | undefined, digits = 1): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return MISSING;
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) return fixed(value, size < 10 ? 4 : size < 1000 ? 2 : 0);
  return value === 0 ? "0" : value.toExponential(digits).replaceAll("-", MINUS).replace("+", "");
}

/** The same rule, by the name of what it is mostly used for. */
export const small = (value: number | null | undefined): string => scientific(value);

/** "850 µs", "12.3 ms", "3.42 s", "2 min". */
export function duration(ms: number | null | undefined): string {
  if (ms === null || ms === undefined || !Number.isFinite(ms)) return MISSING;
  if (ms < 1) return `${Math.round(ms * 1000)} µs`;
  if (ms < 10) return `${ms.toFixed(1)} ms`;
  if (ms < 1000) return `${Math.round(ms)} ms`;
  if (ms < 120_000) return `${(ms / 1000).toFixed(ms < 10_000 ? 2 : 1)} s`;
  return `${Math.round(ms / 60_000)} min`;
}

/** "0:03.214" of a flight; negative in the lead-in. */
export function clock(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return MISSING;
  const sign = seconds < 0 ? MINUS : "";
  const tenths = Math.floor(Math.abs(seconds) * 100) / 100;
  const minutes = Math.floor(tenths / 60);
  return `${sign}${minutes}:${(tenths - 60 * minutes).toFixed(2).padStart(5, "0")}`;
}

export function bytes(count: number | null | undefined): string {
  if (count === null || count === undefined) return MISSING;
  if (count < 1000) return `${count} B`;
  if (count < 1e6) return `${(count / 1e3).toFixed(count < 1e4 ? 1 : 0)} kB`;
  return count < 1e9 ? `${(count / 1e6).toFixed(1)} MB` : `${(count / 1e9).toFixed(1)} GB`;
}

export function integer(value: number | null | undefined): string {
  return value === null || value === undefined || !Number.isFinite(value) ? MISSING : value.toLocaleString("en-US");
}

/** The time of day here, of seconds since 1970. */
export function clockTime(seconds: number): string {
  return new Date(seconds * 1000).toLocaleTimeString([], { hour12: false });
}

/** Date and time here, of a time as the server writes it; with seconds where they tell one from another. */
export function dateTime(written: string, seconds = false): string {
  return new Date(written).toLocaleString([], { dateStyle: "medium", timeStyle: seconds ? "medium" : "short" });
}

/** Date and time here, of seconds since 1970. */
export function dateTimeOf(seconds: number): string {
  return new Date(seconds * 1000).toLocaleString([], { dateStyle: "medium", timeStyle: "medium", hour12: false });
}
