/** What a form sends: whether it is under way, and why it was not taken. */
import { messageOf } from "../net/errors";

export class Sending {
  busy = $state(false);
  problem: string | null = $state(null);

  /** Sends it, where nothing is under way: whether it was taken. */
  async send(request: () => Promise<unknown>): Promise<boolean> {
    if (this.busy) return false;
    this.busy = true;
    this.problem = null;
    try {
      await request();
      return true;
    } catch (error) {
      this.problem = messageOf(error);
      return false;
    } finally {
      this.busy = false;
    }
  }
}
