// What page and server say to each other: JSON both ways, and binary frames of float32 numbers back.
export type Place = number[];

export interface Refusal {
  message: string;
  repair?: string;
}

export interface Row {
  on: boolean;
  allowed: boolean;
  why?: string | null;
  value?: number | number[] | string | null;
  unit?: string | null;
}
export type RowName = "ground" | "guide" | "drive" | "fixed" | "trace" | "mass" | "load";
export const ROWS: RowName[] = ["ground", "guide", "drive", "fixed", "trace", "mass", "load"];

export interface Handles {
  edit: boolean;
  move: boolean;
  why?: string | null;
}
export interface ScenePoint {
  name: string;
  at: Place | null;
  kind: "fixed" | "moving" | "coupler";
  links: string[];
  traced?: boolean;
  centre?: boolean;
  held?: boolean;
  handles: Handles;
}
export interface SceneLink {
  name: string;
  points: string[];
  length?: number | null;
  angle?: number | null;
  locked?: boolean;
  drive?: boolean;
}
export interface SceneGuide {
  name: string;
  point: string;
  on: string;
  through: Place | null; // both in axes of the frame, at the initial position
  direction: number | null;
  circle?: { pole: Place; radius: number } | null; // on the sphere, where its link carries it at the initial position
  link?: string | null;
  slider?: boolean;
}
export interface SceneWheel {
  link: string;
  centre: string;
  radius: number;
  pitch?: boolean; // a circle in which wheels mesh
  track?: { on: string; at: Place; radius: number | null; direction: number | null } | null; // where it lies at the initial position
}
export interface DrivingCam {
  centre: Place;
  outline: Place[]; // these at the first sample
  mark: Place[];
  roller: number | null;
}
export interface SceneDrive {
  name: string;
  kind: string;
  link?: string | null;
  at?: string | null;
  speed?: number | null;
}
export interface SceneLoad {
  name: string;
  point?: string | null;
  vector?: number[] | null;
}
export interface Dimension {
  path: string;
  name: string;
  of?: string | null;
  shown: string;
  unit: string;
  locked?: boolean;
  lockable?: boolean;
}
export interface Segment {
  path: string;
  from: number;
  to: number;
  kind: string;
  law?: string | null;
  laws?: string[];
  names?: Record<string, string>;
}
export interface CamFollower {
  sense: 1 | -1; // counter-clockwise or clockwise
  contact: "knife" | "roller" | "flat";
  places: (number | null)[][] | null; // sample by sample: of the roller's centre, the edge, the foot on a face
  faces: (number | null)[][] | null; // ends of what is straight of a flat face
  pivot: Place | null;
}
export interface CamScene {
  profile: Place[];
  pitch?: Place[] | null;
  base: number | null;
  roller?: number | null;
  displacement: { missing?: string; repair?: string; unit?: string; angle?: number[]; lift?: (number | null)[]; velocity?: (number | null)[]; acceleration?: (number | null)[] } | null;
  follower?: CamFollower | null; // of a plate cam
  carrier?: number[] | null; // angles of what leads a roller around a cam that stands
  segments: Segment[];
  open?: boolean; // whether the path of the roller does not return
  missing?: string;
  repair?: string;
}
export interface Display {
  length: { unit: string; factor: number };
  angle: { unit: string; factor: number };
}
export interface Scene {
  kind: "plane" | "sphere" | "cam";
  draws?: boolean;
  title?: string;
  size?: [Place, Place] | null;
  display?: Display;
  points: ScenePoint[];
  links: SceneLink[];
  guides: SceneGuide[];
  wheels?: SceneWheel[];
  cylinders?: [string, string][];
  drives: SceneDrive[];
  loads: SceneLoad[];
  dimensions?: Dimension[];
  rows: Record<string, Partial<Record<RowName, Row>>>;
  topics?: Record<string, true | string>;
  cam?: CamScene;
}
export interface Problem {
  message: string;
  line?: number | null;
  column?: number | null;
  path?: string | null;
  repair?: string | null;
}
export interface Fact {
  label: string;
  text: string;
}
export interface Readiness {
  mobility?: number | null;
  facts: Fact[];
  ready?: boolean;
  loose: string[];
  missing: string[];
  limit?: string | null;
}
export interface Reading {
  text: string;
  digest: string;
  scene: Scene | null;
  problems: Problem[];
  readiness: Readiness | null;
  changed?: string[];
  named?: string[]; // what an edit made
  held?: string; // why a joint that was dropped does not stand where it was put
  error?: Refusal;
}
export interface TopicOption {
  name: string;
  label: string;
  kind: "choice" | "number" | "text" | "flag";
  choices?: { value: string; label: string }[];
  least?: number;
  most?: number;
  value?: string | number | boolean | null;
  of?: string | null; // kind of the objects that it names
}
export interface Topic {
  name: string;
  title: string;
  formats?: string[];
  options?: TopicOption[];
  for?: string;
}
export interface Template {
  name: string;
  title: string;
  kind: string;
}
export interface Export {
  name: string;
  title: string;
  formats: string[];
  for?: string;
}
export interface Hello {
  version: string;
  language?: string;
  languages: { code: string; name: string }[];
  words: Record<string, string>;
  units?: Record<string, string>;
  templates: Template[];
  file: { name: string; text: string } | null;
  folder?: string; // a digest of its path
  topics: Topic[];
  exports?: Export[];
  decimal: string;
  blank?: string;
}
export interface Column {
  head: string;
  unit?: string;
  numeric?: boolean;
}
export interface Curve {
  label: string;
  unit: string;
  values: (number | null)[];
  x?: (number | null)[];
  finer?: { x: (number | null)[]; values: (number | null)[] };
  dashed?: boolean;
  pen?: number; // its place among the things of its kind: the same colour in every picture
}
export type EventSign = "impact" | "stick" | "slip" | "close" | "open" | "user" | "other";
// A motion that a topic has found, with what its slider marks; instants in seconds.
export interface MotionBlock {
  kind: "motion";
  number: number;
  title?: string;
  loops: boolean;
  marks: { at: number; label: string; sign: EventSign }[];
  held: { from: number; to: number; label: string }[];
  events: { title: string; columns: string[]; rows: string[][]; count: number } | null; // a row for each of the first marks
}
export type Block =
  | { kind: "facts"; facts: Fact[] }
  | { kind: "table"; title?: string; columns: Column[]; rows: (string | number | null)[][] }
  | { kind: "plot"; title?: string; x: Curve & { ends?: [number, number] | null }; y?: { label: string; unit: string }; curves: Curve[]; cursor?: string | null; marks?: { label: string; at: number | null }[]; shaded?: [number | null, number | null][] }
  | { kind: "picture"; title?: string; svg: string; alt?: string }
  | MotionBlock
  | { kind: "formula"; text?: string; mathml?: string }
  | { kind: "paragraph"; text: string; item?: boolean }
  | { kind: "heading"; text: string }
  | { kind: "arrows"; title?: string; unit: string; at: string[]; labels?: string[]; vectors: (number | null)[][][] };
export interface Panel {
  topic: string;
  title: string;
  blocks: Block[];
  options?: TopicOption[];
  missing?: string;
  repair?: string;
  frame?: Frame; // of the motions that it plays
}
export interface Completion {
  label: string;
  detail?: string;
  type?: string;
}
export interface Completions {
  from: number; // column, from 1
  options: Completion[];
}

// A binary frame: length of the header, the header as JSON, float32 numbers.
export interface Frame {
  id: number;
  header: Record<string, any>;
  arrays: Record<string, { shape: number[]; numbers: Float32Array }>;
}
export const isFrame = (answer: unknown): answer is Frame =>
  typeof answer === "object" && answer !== null && "arrays" in answer && "header" in answer;

export function readFrame(bytes: ArrayBuffer): Frame {
  const length = new DataView(bytes).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const begin = 4 + Math.ceil(length / 4) * 4;
  const numbers = new Float32Array(bytes, begin, (bytes.byteLength - begin) >> 2);
  const arrays: Frame["arrays"] = {};
  for (const [name, { shape, offset }] of Object.entries(header.arrays as Record<string, { shape: number[]; offset: number }>)) {
    const size = shape.reduce((product, side) => product * side, 1);
    arrays[name] = { shape, numbers: numbers.subarray(offset, offset + size) };
  }
  return { id: header.id, header, arrays };
}
