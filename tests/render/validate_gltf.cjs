// node validate_gltf.cjs FILE.glb: the Khronos validator's errors and warnings, one a line; exit 1
// when there is any.
const fs = require("fs");
const validator = require("gltf-validator");

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then((report) => {
  const bad = report.issues.messages.filter((message) => message.severity < 2);
  for (const { code, message, pointer } of bad) console.log(`${code} ${pointer}: ${message}`);
  console.log(`animations ${report.info.animationCount}, triangles ${report.info.totalTriangleCount}`);
  process.exit(bad.length ? 1 : 0);
}, (error) => {
  console.log(String(error));
  process.exit(1);
});
