// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { expect, it } from "vitest";
import type { ExportKind } from "../../contract/types";
import { TestConsole } from "../../testing/console";
import Downloads from "./Downloads.svelte";

const KINDS: ExportKind[] = [
  { format: "csv", label: "CSV", available: true, install: null },
  { format: "tdms", label: "TDMS", available: false, install: "pip install 'fullpose[tdms]'" },
];
const props = { of: "run r1", url: (format: string) => `/r1.${format}` };

/** happy-dom has no popovers: the event that a browser sends when one opens. */
async function open(): Promise<void> {
  const event = Object.assign(new Event("toggle"), { newState: "open", oldState: "closed" });
  await fireEvent(screen.getByLabelText("Download run r1 as"), event);
}

it("asks for the kinds once it is opened, and names what the server lacks", async () => {
  const console = new TestConsole({ exports: KINDS });
  console.show(Downloads, props);
  expect(console.asked).toEqual([]);
  await open();
  expect((await screen.findByText("CSV")).closest("a")?.getAttribute("href")).toBe("/r1.csv");
  expect(screen.getByText("TDMS").closest("a")).toBeNull();
  expect(screen.getByText("the server needs pip install 'fullpose[tdms]'")).toBeTruthy();
  await open();
  expect(console.asked).toEqual([["exports"]]);
});

it("says why there are none, and asks again", async () => {
  const console = new TestConsole({ exports: new Error("The server does not answer.") });
  console.show(Downloads, props);
  await open();
  expect((await screen.findByRole("alert")).textContent).toBe("The server does not answer.");
  await open();
  expect(console.asked).toEqual([["exports"], ["exports"]]);
});
