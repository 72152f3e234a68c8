/** Reads a table of comma-separated values: a list of rows, each an object by the titles of its columns. */
export function readCsv(text) {
  const rows = [];
  let row = [];
  let cell = "";
  let isQuoted = false;
  for (let i = 0; i < text.length; ++i) {
    const character = text[i];
    if (isQuoted && character === '"' && text[i + 1] === '"') {
      cell += '"';
      ++i;
    } else if (character === '"') {
      isQuoted = !isQuoted;
    } else if (!isQuoted && (character === "," || character === "\n")) {
      row.push(cell);
      cell = "";
      if (character === "\n") {
        rows.push(row);
        row = [];
      }
    } else {
      cell += character;
    }
  }
  const [titles, ...others] = rows;
  return others.map((cells) => Object.fromEntries(titles.map((title, i) => [title, cells[i]])));
}
