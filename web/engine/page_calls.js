// Part of build/wasm/bin/velo.js (emscripten's --js-library): what apps/velo/view/page.c asks of the page that holds the program,
// Module.page: { message, onText(text), onFrame(buffer) }.
mergeInto(LibraryManager.library, {
  velo_page_here: function () {
    return Module['page'] ? 1 : 0;
  },
  velo_page_post: function (text) {
    Module['page'].onText(UTF8ToString(text));
  },
  velo_page_show: function (bytes, size) {
    Module['page'].onFrame(HEAPU8.slice(bytes, bytes + size).buffer);
  },
  velo_page_take: function (to, room) {
    return stringToUTF8(Module['page'].message, to, room);
  },
});
