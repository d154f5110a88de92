// Checks glTF files with Khronos' validator: node validate_gltf.mjs FILE...
// Prints every error and warning, and exits with 1 if there is one. Needs the npm package gltf-validator, in
// a node_modules folder beside this file, above it, or in a folder that NODE_PATH names.
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import path from 'node:path';

const validator = createRequire(import.meta.url)('gltf-validator');
const files = process.argv.slice(2);
if (files.length === 0) {
    console.error('usage: node validate_gltf.mjs FILE...');
    process.exit(2);
}
const severities = ['error', 'warning'];
let failed = 0;
for (const file of files) {
    const folder = path.dirname(file);
    const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
        uri: path.basename(file),
        maxIssues: 100,
        externalResourceFunction: async (uri) =>
            new Uint8Array(await readFile(path.join(folder, decodeURIComponent(uri)))),
    });
    const {numErrors, numWarnings, messages} = report.issues;
    for (const message of messages)
        if (message.severity < severities.length)
            console.log(`${file}: ${severities[message.severity]}: ${message.code} at ${message.pointer}: ${message.message}`);
    console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${report.info.totalTriangleCount} triangles`);
    if (numErrors + numWarnings > 0) failed++;
}
process.exit(failed > 0 ? 1 : 0);
