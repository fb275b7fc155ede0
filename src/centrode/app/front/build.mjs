// Bundles the page into the folder that the package serves; `--out DIR` elsewhere, which a test compares.
import { copyFile, mkdir } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const at = process.argv.indexOf("--out");
const out = at > 0 ? resolve(process.argv[at + 1]) : resolve(here, "../static");
await mkdir(out, { recursive: true });
await esbuild.build({
  absWorkingDir: here,
  entryPoints: [{ in: "app.tsx", out: "app" }, { in: "editor.ts", out: "editor" }, { in: "app.css", out: "app" }],
  bundle: true,
  minify: true,
  charset: "utf8",
  format: "esm",
  target: "es2022",
  jsx: "automatic",
  jsxImportSource: "preact",
  legalComments: "inline",
  external: ["./editor.js"],
  outdir: out,
  loader: { ".woff": "file" },
  assetNames: "[name]",
  logLevel: "warning",
});
await copyFile(join(here, "index.html"), join(out, "index.html"));
