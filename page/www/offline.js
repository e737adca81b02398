// Keeps the page's files for when there is no network. With one, the newest are taken.
const FILES = ["./", "index.html", "style.css", "icon.svg", "main.js", "panels.js", "plots.js", "sources.js", "stage.js", "worker.js", "tenax.wasm"];
const kept = caches.open("tenax");

oninstall = event => event.waitUntil(kept.then(cache => cache.addAll(FILES)).then(() => skipWaiting()));
onactivate = event => event.waitUntil(clients.claim());
async function newest(request) {
  const cache = await kept;
  try {
    const answer = await fetch(request);
    if (answer.ok) await cache.put(request, answer.clone());
    return answer;
  } catch (error) {
    const own = await cache.match(request, { ignoreSearch: true });
    if (!own) throw error;
    return own;
  }
}
onfetch = event => { if (event.request.method === "GET" && new URL(event.request.url).origin === location.origin) event.respondWith(newest(event.request)); };
