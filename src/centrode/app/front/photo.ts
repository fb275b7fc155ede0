// A photograph behind the drawing, set to scale by a line whose length is known.
import { signal } from "@preact/signals";
import type { Place } from "./protocol";

export interface Photo {
  url: string;
  x: number;
  y: number;
  wide: number;
  high: number; // metres
  opacity: number;
}
export const photo = signal<Photo | null>(null);
export const scalePhoto = signal<((from: Place, to: Place) => void) | null>(null);

const STORE = "centrode.photo";
const MOST = 2400; // pixels of a side that are kept

// Reads a picture of the user's, made smaller where it is larger than any screen.
export async function readPhoto(file: Blob, middle: Place, wide: number): Promise<void> {
  const bitmap = await createImageBitmap(file), share = Math.min(1, MOST / Math.max(bitmap.width, bitmap.height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(bitmap.width * share);
  canvas.height = Math.round(bitmap.height * share);
  canvas.getContext("2d")!.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  const high = (wide * canvas.height) / canvas.width;
  put({ url: canvas.toDataURL("image/jpeg", 0.85), x: middle[0]! - wide / 2, y: middle[1]! - high / 2, wide, high, opacity: 0.5 });
}

export function put(next: Photo | null): void {
  photo.value = next;
  try {
    if (next) localStorage.setItem(STORE, JSON.stringify(next));
    else localStorage.removeItem(STORE);
  } catch {
    // too large for the store: it stays in the window
  }
}

// The line from one place to another has this length: the photo grows about the first.
export function scaleTo(from: Place, to: Place, length: number): void {
  const now = photo.value, drawn = Math.hypot(to[0]! - from[0]!, to[1]! - from[1]!);
  if (!now || !(drawn > 0) || !(length > 0)) return;
  const share = length / drawn;
  put({ ...now, x: from[0]! + (now.x - from[0]!) * share, y: from[1]! + (now.y - from[1]!) * share, wide: now.wide * share, high: now.high * share });
}

try {
  const kept = JSON.parse(localStorage.getItem(STORE) ?? "null");
  if (kept && typeof kept.url === "string" && kept.url.startsWith("data:image/")) photo.value = kept;
} catch {
  // nothing was kept
}
