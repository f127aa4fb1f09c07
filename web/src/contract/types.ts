/** The wire models by the names the console uses; all of them come from the generated schema. */
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Alarm = Schemas["AlarmOut"];
export type CommandOut = Schemas["CommandOut"];
export type Comparison = Schemas["ComparisonOut"];
export type FrameName = keyof Schemas["FramesOut"];
export type Health = Schemas["HealthOut"];
export type Lease = Schemas["LeaseOut"];
export type LeaseAction = Schemas["LeaseIn"]["action"];
export type LeaseToken = Schemas["LeaseToken"];
export type LiveHealth = Schemas["LiveOut"];
export type Method = Schemas["MethodOut"];
export type MethodFigures = Schemas["MethodFiguresOut"];
export type Peak = Schemas["PeakOut"];
export type Plan = Schemas["PlanOut"];
export type PlanIn = Schemas["PlanIn"];
export type PlanMargin = Schemas["MarginOut"];
export type PlanSamples = Schemas["PlanSamples"];
export type Problem = Schemas["Problem"];
export type RemedyKind = Schemas["RemedyIn"]["kind"];
export type Rig = Schemas["RigOut"];
export type Run = Schemas["RunOut"];
export type ScenePose = Schemas["ScenePoseOut"];
export type Snapshot = Schemas["SessionOut"];
export type StateName = Schemas["State"];
export type Trajectory = Schemas["TrajectoryOut"];
export type TrajectoryPreview = Schemas["TrajectoryPreview"];

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
