/** Sound and notification for alarms: chosen once for this browser, and kept. */
import type { Alarm } from "../contract/types";

const KEY = "fullpose.alerts";
/** Two tones a second apart would be a song; one short fall says "look" [Hz, s]. */
const TONES = [880, 660] as const;
const TONE_S = 0.18;

/** How the browser is heard and seen: apart, since a test has neither. */
export interface Signals {
  sound: () => void;
  /** Asks the person, where it was not asked before: whether notifications may be shown. */
  permit: () => Promise<boolean>;
  notify: (title: string, text: string) => void;
}

export class Alerts {
  /** Null while nothing was chosen. */
  on: boolean | null = $state(null);
  #known: readonly string[] = [];
  #first = true;

  constructor(private readonly signals: Signals = BROWSER) {
    const kept = localStorage.getItem(KEY);
    this.on = kept === null ? null : kept === "on";
  }

  async choose(on: boolean): Promise<void> {
    this.on = on;
    localStorage.setItem(KEY, on ? "on" : "off");
    if (!on) return;
    this.signals.sound(); // so is known how it sounds; and a browser lets only a press begin
    await this.signals.permit();
  }

  /** Another rig is operated: what stands there is no news. */
  anew(): void {
    this.#known = [];
    this.#first = true;
  }

  /** Takes in the alarms that wait: what is new is heard, and shown where the page is not in sight. */
  observe(rig: string, waiting: readonly Alarm[], hidden: boolean): void {
    const fresh = waiting.filter((alarm) => !this.#known.includes(keyOf(alarm)));
    this.#known = [...this.#known, ...fresh.map(keyOf)];
    const first = this.#first;
    this.#first = false;
    if (first || fresh.length === 0 || this.on !== true) return;
    this.signals.sound();
    if (hidden) this.signals.notify(`${rig}: ${fresh.length} alarm${fresh.length === 1 ? "" : "s"}`, said(fresh));
  }
}

const keyOf = ({ number, count }: Alarm): string => `${number}.${count}`;
const said = (alarms: readonly Alarm[]): string => alarms.map(({ message }) => message).join("; ");

let context: AudioContext | null = null;

const BROWSER: Signals = {
  sound: () => {
    context ??= new AudioContext();
    const begin = context.currentTime;
    const gain = context.createGain();
    gain.connect(context.destination);
    gain.gain.setValueAtTime(0.2, begin);
    gain.gain.linearRampToValueAtTime(0, begin + TONE_S * TONES.length);
    TONES.forEach((hertz, i) => {
      if (context === null) return;
      const tone = context.createOscillator();
      tone.frequency.value = hertz;
      tone.connect(gain);
      tone.start(begin + i * TONE_S);
      tone.stop(begin + (i + 1) * TONE_S);
    });
  },
  permit: async () => "Notification" in window && (await Notification.requestPermission()) === "granted",
  notify: (title, body) => {
    if ("Notification" in window && Notification.permission === "granted")
      new Notification(title, { body, tag: title });
  },
};
