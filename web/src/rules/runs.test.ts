import { expect, test } from "vitest";

import { ending } from "./runs";

test("an end is told in words, a fault with its code", () => {
  expect(ending("completed", null)).toMatchObject({ text: "completed", orderly: true });
  expect(ending("stopped", null).orderly).toBe(true);
  expect(ending("fault", "drive_hangs")).toMatchObject({ text: "fault: drive hangs", orderly: false });
  expect(ending("fault", null).text).toBe("fault");
  expect(ending("estop", "estop").text).toBe("E-stop");
  expect(ending("process_lost", null)).toMatchObject({ text: "process lost", orderly: false });
});
