/** Uploads a flight; XMLHttpRequest because fetch does not tell how much of a body has been sent. */
import type { Convention, FlightForm, Trajectory } from "../contract/types";
import { refusal, silence } from "./errors";
import { CLIENT_HEADER, me } from "./identity";
import { pathTo } from "./request";

export type Progress = (fraction: number) => void;

export function upload(file: File, convention: Convention, progress: Progress): Promise<Trajectory> {
  const form = formOf({ name: file.name.replace(/\.(csv|parquet)$/i, ""), convention }, file);
  return new Promise((resolve, reject) => {
    const sending = new XMLHttpRequest();
    sending.open("POST", pathTo("/api/v1/trajectories", {}));
    sending.setRequestHeader(CLIENT_HEADER, me());
    sending.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    sending.onload = () => {
      if (sending.status >= 200 && sending.status < 300) resolve(JSON.parse(sending.responseText) as Trajectory);
      else reject(refusal(sending.status, sending.responseText));
    };
    sending.onerror = () => reject(silence());
    sending.send(form);
  });
}

function formOf(fields: Omit<FlightForm, "file">, file: File): FormData {
  const form = new FormData();
  for (const [name, value] of Object.entries(fields)) form.set(name, value);
  const place: keyof FlightForm = "file";
  form.set(place, file);
  return form;
}
