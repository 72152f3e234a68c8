import assert from "node:assert";
import test from "node:test";
import { readCsv } from "../../page/src/csv.js";

test("cells in quotation marks may hold commas, quotation marks and ends of lines", () => {
  assert.deepStrictEqual(readCsv('a,b\n1,"x, ""y""\nz"\n,2\n'), [{ a: "1", b: 'x, "y"\nz' }, { a: "", b: "2" }]);
});
