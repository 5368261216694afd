// SPDX-License-Identifier: MIT
// node validate.mjs MODULE FOLDER: has gltf-validator, the package at MODULE, judge every model in FOLDER. An output has
// no error, and no warning that its input has not.
import fs from "node:fs";
import path from "node:path";
import { createRequire } from "node:module";

const [module, folder] = process.argv.slice(2);
const validator = createRequire(import.meta.url)(path.resolve(module));

async function judge(name) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path.join(folder, name))), {
        uri: name,
        maxIssues: 0,
        externalResourceFunction: async (uri) =>
            new Uint8Array(fs.readFileSync(path.join(folder, decodeURIComponent(uri)))),
    });
    return report.issues;
}

let failed = 0, judged = 0;
const warned = new Map();
const names = fs.readdirSync(folder).filter((name) => /\.(glb|gltf)$/.test(name)).sort();
for (const name of [...names.filter((n) => n.includes(".in.")), ...names.filter((n) => !n.includes(".in."))]) {
    const { messages } = await judge(name);
    const codes = (severity) => new Set(messages.filter((m) => m.severity === severity).map((m) => m.code));
    const model = name.replace(/(-[0-9]+|\.in)?\.(glb|gltf)$/, "");
    if (name.includes(".in.")) warned.set(model, codes(1));
    const known = warned.get(model) ?? new Set();
    const bad = messages.filter((m) => m.severity === 0 || (m.severity === 1 && !known.has(m.code)));
    for (const m of bad.slice(0, 5)) console.log(`${name}: ${m.code} at ${m.pointer}: ${m.message}`);
    if (process.env.TAUT_VERBOSE) console.log(name, JSON.stringify([...codes(0), ...codes(1), ...codes(2)]));
    failed += bad.length > 0;
    ++judged;
}
console.log(`${judged} models judged, ${failed} with errors or new warnings`);
process.exit(failed > 0 || judged < 20 ? 1 : 0);
