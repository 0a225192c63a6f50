// Validates glTF files: prints each error and warning of Khronos' validator, and exits with 1 if
// there is one, with 2 if nothing was given to validate.
//
// Usage: node validate.mjs FILE..      after `npm install` in this folder

import { readFile } from 'node:fs/promises';

import { validateBytes } from 'gltf-validator';

const severities = ['error', 'warning'];
const paths = process.argv.slice(2);
if (paths.length === 0) process.exit(2);
for (const path of paths) {
  const report = await validateBytes(new Uint8Array(await readFile(path)), { uri: path });
  for (const { severity, code, message, pointer } of report.issues.messages) {
    if (severity >= severities.length) continue;
    console.log(`${path}: ${severities[severity]} ${code} at ${pointer}: ${message}`);
    process.exitCode = 1;
  }
}
