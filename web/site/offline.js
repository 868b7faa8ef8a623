// web/site/offline.js: the site works offline after its first load, where the browser has service workers: on https and localhost.
navigator.serviceWorker?.register(new URL("../service_worker.js", import.meta.url)).catch(() => {});
