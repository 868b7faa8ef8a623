// Part of build/wasm/bin/velo.js (emscripten's --js-library): gives web/engine/rgb_tables.c a table from
// Module.rgbTables, an object {space: Uint8Array}, or throws {rgbTable: space}.
mergeInto(LibraryManager.library, {
  velo_copy_rgb_table: function (space, coefficients, size) {
    var table = Module['rgbTables'] && Module['rgbTables'][space];
    if (!table) throw { rgbTable: space };
    if (table.length !== size) throw new Error('the RGB table ' + space + ' has a wrong size');
    HEAPU8.set(table, coefficients);
  },
});
