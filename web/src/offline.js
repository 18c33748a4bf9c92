// Keeps the files of the app, so that it works without a network.
const FILES = ['./', 'app.js', 'worker.js', 'style.css', 'pkg/seamstress_wasm.js', 'pkg/seamstress_wasm_bg.wasm'];
// Others may be at home on the same host.
const OWN = `seamstress ${registration.scope} `;
const NAME = `${OWN}BUILD`;

addEventListener('install', (event) => {
    event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES)));
});
addEventListener('activate', (event) => {
    const old = caches.keys().then((names) => Promise.all(names.filter((name) => name.startsWith(OWN) && name !== NAME).map((name) => caches.delete(name))));
    event.waitUntil(old);
});
addEventListener('fetch', (event) => {
    event.respondWith(caches.match(event.request, { cacheName: NAME }).then((kept) => kept ?? fetch(event.request)));
});
