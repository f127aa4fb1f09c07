/** A WebSocket that is kept: opened anew after every loss, asked for its round trip, given up when nothing comes. */

export const PING_PERIOD_MS = 1000;
/** No word from the server for this long: the socket is dead even where the network has not said so. */
export const SILENCE_MS = 5000;

/** Delay before attempt `n` (1, 2, ...): doubles from 250 ms to 5 s, spread so that consoles do not return in step. */
export function backoffMs(attempt: number, random: number): number {
  return Math.min(5000, 250 * 2 ** (attempt - 1)) * (0.75 + 0.5 * random);
}

/** The parts of WebSocket that this needs, so that a test can stand in for the network. */
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  send(text: string): void;
  close(): void;
}

export interface Surroundings {
  open: (url: string) => Socket;
  now: () => number;
  random: () => number;
  setTimeout: (run: () => void, ms: number) => number;
  clearTimeout: (id: number) => void;
}

export const BROWSER: Surroundings = {
  open: (url) => new WebSocket(url) as unknown as Socket,
  now: () => performance.now(),
  random: () => Math.random(),
  setTimeout: (run, ms) => window.setTimeout(run, ms),
  clearTimeout: (id) => window.clearTimeout(id),
};

/** What the server closes one with whose session or token has ended (server: api/close_codes.py). */
const UNKNOWN = 4401;

export interface SocketListener {
  connecting?: () => void;
  opened?: () => void;
  received: (data: unknown) => void;
  lost: (reason: string) => void;
  /** The server let it in no longer, or may have let it in never: a browser does not tell that from a network that fails. */
  refused?: (() => void) | undefined;
}

export class KeptSocket {
  #socket: Socket | null = null;
  #attempt = 0;
  #opened = false;
  #settled = false;
  #heardAt = 0;
  #closed = false;
  readonly #timers = new Set<number>();

  constructor(
    private readonly url: string,
    private readonly listener: SocketListener,
    private readonly around: Surroundings,
    /** How long the server may take until it is `settle`d. */
    private readonly helloMs = SILENCE_MS,
  ) {
    this.#connect();
  }

  /** Whether `settle` was called since the socket was opened. */
  get settled(): boolean {
    return this.#settled;
  }

  /** The server is known to be there: the next loss is a first one, and a ping goes out each second. */
  settle(): void {
    this.#settled = true;
    this.#attempt = 0;
    this.#ping();
  }

  send(message: object): void {
    this.#socket?.send(JSON.stringify(message));
  }

  close(): void {
    this.#closed = true;
    this.#drop();
  }

  #connect(): void {
    this.listener.connecting?.();
    const socket = this.around.open(this.url);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#heardAt = this.around.now();
    socket.onopen = () => {
      this.#opened = true;
      this.listener.opened?.();
    };
    socket.onmessage = ({ data }) => {
      this.#heardAt = this.around.now();
      this.listener.received(data);
    };
    socket.onclose = ({ code, reason }) => {
      const refused = code === UNKNOWN || !this.#opened;
      this.#lost(reason || `connection closed (${code})`);
      if (refused) this.listener.refused?.();
    };
    this.#watch();
  }

  #ping(): void {
    this.send({ type: "ping", t: this.around.now() });
    this.#later(() => this.#ping(), PING_PERIOD_MS);
  }

  #watch(): void {
    this.#later(() => {
      if (this.around.now() - this.#heardAt > (this.#settled ? SILENCE_MS : this.helloMs))
        this.#lost("no word from the server");
      else this.#watch();
    }, PING_PERIOD_MS);
  }

  #lost(reason: string): void {
    if (this.#closed) return;
    this.#drop();
    this.listener.lost(reason);
    this.#attempt++;
    this.#later(() => this.#connect(), backoffMs(this.#attempt, this.around.random()));
  }

  #drop(): void {
    for (const id of this.#timers) this.around.clearTimeout(id);
    this.#timers.clear();
    const socket = this.#socket;
    this.#socket = null;
    this.#opened = this.#settled = false;
    if (socket) {
      socket.onopen = socket.onmessage = socket.onclose = null;
      socket.close();
    }
  }

  #later(run: () => void, ms: number): void {
    const id = this.around.setTimeout(() => {
      this.#timers.delete(id);
      run();
    }, ms);
    this.#timers.add(id);
  }
}
