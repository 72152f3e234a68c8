// node build.mjs FILE writes the page without its data: HTML with the style and the script in it.
import * as esbuild from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";

const options = { bundle: true, minify: true, write: false, logLevel: "warning", target: "es2020" };

async function bundled(entry, further = {}) {
  const result = await esbuild.build({ entryPoints: [entry], ...options, ...further });
  return result.outputFiles[0].text.trim();
}

const style = await bundled("src/page.css");
// The licence of three.js asks that its notice stay in every copy.
const script = await bundled("src/main.js", { format: "iife", legalComments: "inline" });
const page = readFileSync("src/page.html", "utf8")
  .replace("/* style */", () => style)
  .replace("/* script */", () => script);
writeFileSync(process.argv[2], page);
