// Drawn, since fonts lack the signs.
const PATHS: Record<string, string> = {
  play: "M4 2l10 6-10 6z",
  pause: "M3 2h4v12H3zM9 2h4v12H9z",
};
const LINES: Record<string, string> = {
  draw: "M3.6 12.4L12.4 3.6M3.6 12.4m-1.9 0a1.9 1.9 0 1 0 3.8 0a1.9 1.9 0 1 0-3.8 0M12.4 3.6m-1.9 0a1.9 1.9 0 1 0 3.8 0a1.9 1.9 0 1 0-3.8 0",
  guide: "M1.5 11.5h13M3 14l2-2.5M6.5 14l2-2.5M10 14l2-2.5M4.5 4.5h7v4.4h-7z",
  edit: "M8 1.5v13M1.5 8h13M8 1.5l-2 2M8 1.5l2 2M8 14.5l-2-2M8 14.5l2-2M1.5 8l2-2M1.5 8l2 2M14.5 8l-2-2M14.5 8l-2 2",
  move: "M13.5 8a5.5 5.5 0 1 1-1.9-4.2M13.6 1.6v3.2h-3.2",
  fit: "M2 5.5V2h3.5M10.5 2H14v3.5M14 10.5V14h-3.5M5.5 14H2v-3.5",
  plus: "M8 3v10M3 8h10",
  minus: "M3 8h10",
  undo: "M6 3L2.5 6.5L6 10M3 6.5h6.5a4 4 0 0 1 0 8H7",
  redo: "M10 3l3.5 3.5L10 10M13 6.5H6.5a4 4 0 0 0 0 8H9",
  snap: "M3.5 2v6a4.5 4.5 0 0 0 9 0V2M3.5 5h3M9.5 5h3M6.5 2v6a1.5 1.5 0 0 0 3 0V2M3.5 2h3M9.5 2h3",
  grid: "M2 2h12v12H2zM6 2v12M10 2v12M2 6h12M2 10h12",
  photo: "M2 3h12v10H2zM2 11l3.5-3.5 3 3L11 8l3 3M10.6 5.9m-1 0a1 1 0 1 0 2 0a1 1 0 1 0-2 0",
  keys: "M1.5 4h13v8.5h-13zM4 6.5h.01M6.7 6.5h.01M9.4 6.5h.01M12 6.5h.01M4 10h8",
  lock: "M4 7.5h8v6H4zM5.5 7.5v-2a2.5 2.5 0 0 1 5 0v2",
  unlock: "M4 7.5h8v6H4zM5.5 7.5v-2a2.5 2.5 0 0 1 4.8-1",
  back: "M10 3L5 8l5 5",
  on: "M6 3l5 5-5 5",
  close: "M4 4l8 8M12 4l-8 8",
  ground: "M8 3L5 9h6zM3 9.5h10M4 12l1.5-2.5M7 12l1.5-2.5M10 12l1.5-2.5",
  drive: "M13 8a5 5 0 1 1-2-4M11.2 1.4v3h-3M8 8h.01",
  fixed: "M8 9.5V14M5 9.5h6M6 2.5h4l-.5 4 1.5 3H5l1.5-3z",
  trace: "M2 12c2-8 5-9 6-5s4 3 6-3",
  mass: "M8 2.5a5.5 5.5 0 1 0 0 11a5.5 5.5 0 1 0 0-11M8 2.5V8h5.5M8 13.5V8H2.5",
  load: "M2 8h10M9 4.5L12.5 8L9 11.5",
};
export function Icon({ name }: { name: string }) {
  const path = PATHS[name];
  return (
    <svg class="icon" viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
      {path ? <path fill="currentColor" d={path} /> : <path fill="none" stroke="currentColor" stroke-width="1.3" stroke-linecap="round" stroke-linejoin="round" d={LINES[name]} />}
    </svg>
  );
}
