/** Uploads a flight; XMLHttpRequest because fetch does not tell how much of a body has been sent. */
import type { FlightForm, HowToRead, ReadingPreview, Trajectory } from "../contract/types";
import { refusal, silence } from "./errors";
import { CLIENT_HEADER, me } from "./identity";
import { pathTo } from "./request";

export type Progress = (fraction: number) => void;

export function upload(file: File, how: HowToRead, progress: Progress): Promise<Trajectory> {
  const form = formOf({ name: file.name.replace(/\.[a-z0-9]{1,8}(\.gz)?$/i, ""), ...how }, file);
  return send<Trajectory>("/api/v1/trajectories", form, progress);
}

/** Looks at a file; nothing of it is stored. */
export function lookAt(file: File, how: HowToRead): Promise<ReadingPreview> {
  return send<ReadingPreview>("/api/v1/reading", formOf(how, file), () => undefined);
}

function send<Answer>(
  path: "/api/v1/trajectories" | "/api/v1/reading",
  form: FormData,
  progress: Progress,
): Promise<Answer> {
  return new Promise((resolve, reject) => {
    const sending = new XMLHttpRequest();
    sending.open("POST", pathTo(path, {}));
    sending.setRequestHeader(CLIENT_HEADER, me());
    sending.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    sending.onload = () => {
      if (sending.status >= 200 && sending.status < 300) resolve(JSON.parse(sending.responseText) as Answer);
      else reject(refusal(sending.status, sending.responseText));
    };
    sending.onerror = () => reject(silence());
    sending.send(form);
  });
}

function formOf(fields: Omit<FlightForm, "file">, file: File): FormData {
  const form = new FormData();
  for (const [name, value] of Object.entries(fields)) if (value) form.set(name, String(value));
  const place: keyof FlightForm = "file";
  form.set(place, file);
  return form;
}
