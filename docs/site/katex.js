// One formula a line, {source, display} in JSON, answered by a line {html} or {error}.
const katex = require("katex");
const lines = require("readline").createInterface({input: process.stdin});
lines.on("line", (line) => {
  const {source, display} = JSON.parse(line);
  let answer;
  try {
    answer = {html: katex.renderToString(source, {displayMode: display, throwOnError: true, strict: "error", output: "html"})};
  } catch (error) {
    answer = {error: error.message};
  }
  process.stdout.write(JSON.stringify(answer) + "\n");
});
