/** The wire models by the names the console uses; all of them come from the generated schema. */
import type { components, flags, paths } from "./schema";

type Schemas = components["schemas"];

export type Alarm = Schemas["AlarmOut"];
/** An alarm of the history of all rigs. */
export type AlarmRecord = Schemas["AlarmRecordOut"];
/** Which of them are asked for; null: whatever. */
export type AlarmQuery = NonNullable<paths["/api/v1/alarms"]["get"]["parameters"]["query"]>;
export type AuditLine = Schemas["AuditOut"];
/** A command as it is sent; which ones there are, and what each is given. */
export type CommandBody = paths["/api/v1/rigs/{rig}/commands"]["post"]["requestBody"]["content"]["application/json"];
export type CommandName = CommandBody["command"];
export type ArgsOf<Name extends CommandName> = Given<Extract<CommandBody, { command: Name }>["args"]>;
export type CommandDone = Schemas["CommandOut"];
export type Comparison = Schemas["ComparisonOut"];
/** What there is to draw of a run, and what happened in it. */
export type Curves = Schemas["CurvesOut"];
export type CurveEvent = Schemas["CurveEvent"];
/** Which columns of a file are its time and its attitude. */
export type ColumnMap = Schemas["ColumnMap"];
export type Convention = NonNullable<FlightForm["convention"]>;
/** A kind of file that plans and runs are downloaded as. */
export type ExportKind = Schemas["ExportKindOut"];
export type ExportFormat = ExportKind["format"];
export type Diagnosis = Schemas["DiagnosisOut"];
/** A flight's file as a form. */
export type FlightForm = paths["/api/v1/trajectories"]["post"]["requestBody"]["content"]["multipart/form-data"];
/** How a file is to be read; what is left out is guessed. */
export type HowToRead = Omit<FlightForm, "file" | "name">;
export type Profile = Schemas["ProfileOut"];
export type ReadingPreview = Schemas["ReadingPreview"];
/** One frame's limits in degrees; null for no limit. */
export type FrameLimits = Omit<Schemas["FrameOut"], "weight">;
export type FrameName = keyof Schemas["FramesOut"];
export type Health = Schemas["HealthOut"];
/** Tags and notes that are put in the place of others; what is left out stays. */
export type LabelsIn = Schemas["LabelsIn"];
export type Lease = Schemas["LeaseOut"];
export type LeaseGiven = Schemas["LeaseGiven"];
export type LeaseAction = Schemas["LeaseIn"]["action"];
export type LeaseToken = Schemas["LeaseToken"];
export type LimitName = Schemas["BlockingOut"]["limit"];
export type LiveHealth = Schemas["LiveOut"];
/** Whether one must sign in, and who one is. */
export type Me = Schemas["MeOut"];
export type Method = Schemas["MethodOut"];
export type MethodFigures = Schemas["MethodFiguresOut"];
export type Peak = Schemas["PeakOut"];
export type Person = Schemas["PersonOut"];
export type Plan = Schemas["PlanOut"];
export type PlanMargin = Schemas["MarginOut"];
/** The plane of time and base angle of a plan. */
export type Plane = Schemas["PlaneOut"];
export type PlanSamples = Schemas["PlanSamples"];
export type Problem = Schemas["Problem"];
export type RemedyKind = Schemas["RemedyIn"]["kind"];
export type Rig = Schemas["RigOut"];
export type Role = Person["role"];
export type Run = Schemas["RunOut"];
export type ScenePoseAt = Schemas["ScenePoseIn"];
export type ScenePose = Schemas["ScenePoseOut"];
/** What a list is searched for; null: whatever. */
export type Searched = Pick<NonNullable<paths["/api/v1/runs"]["get"]["parameters"]["query"]>, "q" | "tag">;
export type Severity = Schemas["Severity"];
export type Shelf = Schemas["ShelfOut"];
export type Snapshot = Schemas["SessionOut"];
export type StateName = Schemas["State"];
export type Token = Schemas["TokenOut"];
export type TokenGiven = Schemas["TokenGiven"];
export type TokenWanted = Schemas["TokenIn"];
export type ToleranceEffect = Schemas["ToleranceEffect"];
export type Trajectory = Schemas["TrajectoryOut"];
export type TrajectoryPreview = Schemas["TrajectoryPreview"];
export type User = Schemas["UserOut"];
export type UserChange = Schemas["UserChange"];
export type UserWanted = Schemas["UserIn"];

// The stream's messages.
export type RecordDescription = Schemas["Record"];
export type PlaybackControl = Extract<Schemas["StreamMessageIn"], { type: "seek" | "speed" | "pause" | "play" }>;
export type Replayed = Schemas["Replayed"];
export type ReplayOf = Schemas["ReplayOf"];
export type Subscribe = Schemas["Subscribe"];
export type TelemetryMessage = Schemas["Telemetry"];
export type ServerMessage = Schemas["StreamMessageOut"];

/** From the outside in; the order of every array of four. */
export const FRAMES: readonly FrameName[] = ["base", "outer", "middle", "inner"];
export const STREAM_SCHEMA: Schemas["Hello"]["schema"] = "fullpose.stream/1";
/** Bits of a sample's flags that the console shows. */
export const FLAG: Pick<flags, "stale"> = { stale: 32 };

/** What a client may leave out of `T`: the generated types say of a default that it is there, as it is in an answer. */
type Given<T> = T extends readonly unknown[] ? T : T extends object ? { [Key in keyof T]?: Given<T[Key]> } : T;
/** A command that needs no lease and waits for nothing. */
export type Urgent = Schemas["StopRig"]["type"];
