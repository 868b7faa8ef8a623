// test/cli/validate_gltf.js: Khronos' gltf-validator on each file named; exit 1 when it finds an error, 2 when the
// validator is not there. Usage: node validate_gltf.js MODULE FILE...
const fs = require('fs'), path = require('path');
let validator;
try {
  validator = require(process.argv[2]);
} catch (error) {
  process.exit(2);
}
(async () => {
  let errors = 0;
  for (const file of process.argv.slice(3)) {
    const folder = path.dirname(file), read = name => new Uint8Array(fs.readFileSync(name));
    const report = await validator.validateBytes(read(file), {
      uri: path.basename(file),
      externalResourceFunction: uri => Promise.resolve(read(path.join(folder, decodeURIComponent(uri)))),
    });
    errors += report.issues.numErrors;
    for (const m of report.issues.messages)
      if (m.severity === 0) console.log(`${file}: ${m.code}: ${m.message} ${m.pointer || ''}`);
  }
  process.exit(errors ? 1 : 0);
})();
