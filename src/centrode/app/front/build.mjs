// Bundles the page into the folder that the package serves; `--out DIR` elsewhere, which a test compares.
import { mkdir, readFile, readdir, writeFile } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const at = process.argv.indexOf("--out");
const out = at > 0 ? resolve(process.argv[at + 1]) : resolve(here, "../static");
await mkdir(out, { recursive: true });
const built = await esbuild.build({
  metafile: true,
  absWorkingDir: here,
  entryPoints: [{ in: "app.tsx", out: "app" }, { in: "editor.ts", out: "editor" }, { in: "app.css", out: "app" }, { in: "gears.ts", out: "gears" }, { in: "gears.css", out: "gears" }, { in: "synthesis.ts", out: "synthesis" }, { in: "synthesis.css", out: "synthesis" }],
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
// Each page is the same but for what it loads, and whether that makes its main part itself.
const page = await readFile(join(here, "page.html"), "utf8");
for (const [file, name, tag] of [["index", "app", "div"], ["gears", "gears", "main"], ["synthesis", "synthesis", "main"]])
  await writeFile(join(out, `${file}.html`), page.replaceAll("{{name}}", name).replaceAll("{{tag}}", tag));

// The licences of what is bundled go with it.
const packages = [...new Set(Object.keys(built.metafile.inputs).flatMap((file) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(file)?.[1] ?? []))].sort();
const notices = await Promise.all(packages.map(async (name) => {
  const folder = join(here, "node_modules", name), { version, license } = JSON.parse(await readFile(join(folder, "package.json"), "utf8"));
  const file = (await readdir(folder)).find((one) => /^licen[cs]e/i.test(one));
  return `${name} ${version}, ${license}\n\n${file ? (await readFile(join(folder, file), "utf8")).trim() : ""}\n`;
}));
await writeFile(join(out, "licences.txt"), notices.join(`\n${"-".repeat(78)}\n\n`));
