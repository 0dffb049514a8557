// Prints what Khronos' glTF-Validator finds in GLB files; exit 1 if it finds anything.
//   npm install --no-save gltf-validator && node tests/peers/validate_glb.js FILE.glb...
const fs = require('fs');
const path = require('path');
const validator = require(require.resolve('gltf-validator', {paths: [process.cwd(), __dirname]}));

async function main() {
  let found = 0;
  for (const file of process.argv.slice(2)) {
    const {issues} = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    console.log(`${path.basename(file)}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ` +
                `${issues.numInfos} infos, ${issues.numHints} hints`);
    for (const message of issues.messages) console.log(`  ${message.code} ${message.pointer}`);
    found += issues.messages.length;
  }
  process.exit(found > 0 ? 1 : 0);
}
main();
