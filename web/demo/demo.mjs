// demo/demo.mjs: the demonstration page: files are dropped, workers render, the page shows image, hash and receipt.
import { lacks } from './velo.mjs';
import { VeloWorkers } from './workers.mjs';

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

function show(bytes) {
  const image = $('image');
  if (image.src) URL.revokeObjectURL(image.src);
  image.src = URL.createObjectURL(new Blob([bytes], { type: 'image/png' }));
  image.hidden = false;
}

async function finish(files, exr) {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', exr));
  $('hash').textContent = [...digest].map((byte) => byte.toString(16).padStart(2, '0')).join('');
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
    await finish(files, result.files['/image.exr']);
    say(`${names[0].slice(1)}: ${spp} samples per pixel in ${((performance.now() - started) / 1000).toFixed(1)} s.`);
  } catch (error) {
    if (own === workers) say(`velo could not run: ${error.message.replace(/\.$/, '')}. Reload the page, or close others.`, true);
  } finally {
    if (own === workers) $('stop').hidden = true;
  }
}

// All files of dropped folders, by their paths.
async function readEntry(entry, files) {
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    files[entry.fullPath] = new Uint8Array(await file.arrayBuffer());
    return;
  }
  const reader = entry.createReader();
  for (;;) {
    const entries = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return;
    for (const one of entries) await readEntry(one, files);
  }
}

async function readList(list) {
  const files = {};
  for (const file of list) files['/' + file.name] = new Uint8Array(await file.arrayBuffer());
  return files;
}

$('workers').value = navigator.hardwareConcurrency ?? 1;
$('choose').onchange = async (event) => render(await readList(event.target.files));
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
document.ondrop = async (event) => {
  event.preventDefault();
  $('drop').className = '';
  const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
  const files = {};
  for (const entry of entries) await readEntry(entry, files);
  render(files);
};
window.started = true; // index.html says so otherwise
if (lacks()) {
  say(lacks(), true);
  for (const input of document.querySelectorAll('input, button')) input.disabled = true;
  document.ondrop = (event) => event.preventDefault();
} else if (location.hash === '#example') $('example').click();
