// demo/demo.mjs: the demonstration page: files are dropped, workers render, the page shows image, hash and receipt.
import { lacks } from './velo.mjs';
import { sha256 } from './sha256.js';
import { VeloWorkers, lacksWorkers } from './workers.mjs';

const $ = (id) => document.getElementById(id);
const scenes = /\.(pbrt|pbrt\.gz|gltf|glb|obj|ply|stl|off)$/i;
let workers = null;

const example = `LookAt 3 2 4  0 .6 0  0 1 0
Camera "perspective" "float fov" 35
Film "rgb" "integer xresolution" 480 "integer yresolution" 360
WorldBegin
LightSource "infinite" "rgb L" [.35 .45 .6]
AttributeBegin
  Translate -2 4 2
  AreaLightSource "diffuse" "blackbody L" 4500 "float scale" 30
  Shape "sphere" "float radius" .5
AttributeEnd
Material "diffuse" "rgb reflectance" [.5 .45 .4]
Shape "trianglemesh" "point3 P" [-9 0 -9  9 0 -9  9 0 9  -9 0 9] "integer indices" [0 2 1 0 3 2]
AttributeBegin
  Translate -.9 .7 0
  Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" .1
  Shape "sphere" "float radius" .7
AttributeEnd
AttributeBegin
  Translate .8 .6 .5
  Material "dielectric"
  Shape "sphere" "float radius" .6
AttributeEnd
`;

function say(text, error = false) {
  $('message').textContent = text;
  $('message').className = error ? 'error' : '';
}

// What velo said of a scene, as one sentence that says what is wrong and what to do.
function explain(result, name) {
  const lines = result.errors.split('\n').filter((text) => /^velo: (?!warning|note)/.test(text));
  const line = (lines.at(-1) ?? '').replace(/^velo: (error: )?/, '').replace(/\.$/, '');
  if (result.code === 1 && /memory/.test(line)) return `This needs more memory than the browser gives: choose a smaller image, fewer workers or a smaller scene (${line}).`;
  if (result.code === 4) return `A file that ${name} names is missing: drop it together with the scene, or the folder that holds both (${line}).`;
  if (result.code === 3) return `${name} is no scene that velo can read: correct it, or drop another (${line}).`;
  return `velo could not render ${name} (${line || `exit code ${result.code}`}): try other settings, or another scene.`;
}

// The same of what kept velo from running.
function explainError(error) {
  const text = error.message.replace(/\.$/, '');
  if (/memory|allocat/i.test(text)) return `There is too little memory (${text}): close other pages, or choose fewer workers or a smaller image.`;
  if (/: 40[34] /.test(text)) return `The server lacks a file of this page (${text}): it must have the whole folder that script/wasm makes.`;
  return `velo could not run (${text}): reload the page, or close others.`;
}

function show(bytes) {
  const image = $('image');
  if (image.src) URL.revokeObjectURL(image.src);
  image.src = URL.createObjectURL(new Blob([bytes], { type: 'image/png' }));
  image.hidden = false;
}

async function finish(exr) {
  $('hash').textContent = sha256(exr);
  if ($('exr').href) URL.revokeObjectURL($('exr').href);
  $('exr').href = URL.createObjectURL(new Blob([exr]));
  const info = await workers.run(0, ['image', 'info', '/image.exr'], { files: { '/image.exr': exr } });
  $('receipt').textContent = info.output;
  $('result').hidden = false;
}

async function render(files) {
  const names = Object.keys(files).filter((name) => scenes.test(name));
  if (names.length === 0) {
    const kinds = 'a .pbrt, .gltf, .glb, .obj, .ply, .stl or .off file, with the files that it names';
    const first = Object.keys(files)[0]?.slice(1);
    return say(first ? `${first} is no scene: drop ${kinds}.` : `There was no file: drop ${kinds}.`, true);
  }
  const depth = (name) => name.split('/').length;
  const rank = (name) => (/\.(pbrt|gltf|glb)/i.test(name) ? 0 : 1);
  names.sort((a, b) => rank(a) - rank(b) || depth(a) - depth(b) || (a < b ? -1 : 1));
  workers?.close();
  const own = (workers = new VeloWorkers(Number($('workers').value)));
  $('result').hidden = true;
  $('stop').hidden = false;
  const spp = Number($('spp').value);
  const started = performance.now();
  say(`Rendering ${names[0].slice(1)} …`);
  try {
    const result = await own.render({
      scene: names[0],
      files,
      spp,
      args: ['--resolution', `${$('width').value}x${$('height').value}`],
      outputs: ['/image.png', '/image.exr'],
      onImage: (images, done) => {
        show(images['/image.png']);
        say(`${done} of ${spp} samples per pixel …`);
      },
    });
    if (own !== workers) return;
    if (result.code !== 0) return say(explain(result, names[0].slice(1)), true);
    await finish(result.files['/image.exr']);
    say(`${names[0].slice(1)}: ${spp} samples per pixel in ${((performance.now() - started) / 1000).toFixed(1)} s.`);
  } catch (error) {
    if (own === workers) say(explainError(error), true);
  } finally {
    if (own === workers) $('stop').hidden = true;
  }
}

async function readFile(file) {
  return new Uint8Array(await file.arrayBuffer());
}

// All files of dropped folders, by their paths.
async function readEntry(entry, files) {
  if (entry.isFile) {
    files[entry.fullPath] = await readFile(await new Promise((resolve, reject) => entry.file(resolve, reject)));
    return;
  }
  const reader = entry.createReader();
  for (;;) {
    const entries = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return;
    for (const one of entries) await readEntry(one, files);
  }
}

// Renders what `read` puts into the files that it is given.
async function renderRead(read) {
  const files = {};
  try {
    await read(files);
  } catch (error) {
    return say(`The browser could not read the files (${error.message.replace(/\.$/, '')}): drop them again, or fewer of them.`, true);
  }
  await render(files);
}

$('workers').value = navigator.hardwareConcurrency ?? 1;
$('choose').onchange = (event) =>
  renderRead(async (files) => {
    for (const file of event.target.files) files['/' + file.name] = await readFile(file);
  });
$('example').onclick = () => render({ '/example.pbrt': new TextEncoder().encode(example) });
$('stop').onclick = () => {
  workers?.close();
  workers = null;
  $('stop').hidden = true;
  say('Stopped.');
};
document.ondragover = (event) => {
  event.preventDefault();
  $('drop').className = 'over';
};
document.ondragleave = () => ($('drop').className = '');
document.ondrop = (event) => {
  event.preventDefault();
  $('drop').className = '';
  const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
  renderRead(async (files) => {
    for (const entry of entries) await readEntry(entry, files);
  });
};
window.started = true; // index.html says so otherwise
const missing = lacks() ?? lacksWorkers();
if (missing) {
  say(missing, true);
  for (const input of document.querySelectorAll('input, button')) input.disabled = true;
  document.ondrop = (event) => event.preventDefault();
} else if (location.hash === '#example') $('example').click();
