// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The page: takes a mesh and the fields, has the worker simplify it, shows the report. What it
// needs stands in elements of the page, packed, so that it opens from a disk as well.

'use strict';
(() => {
const element = name => document.getElementById(name);
const grouped = n => n.toLocaleString('en-US');
const demonstration = 'shape.ply';
let wasm = null, worker = null, mesh = null, started = 0, addresses = [];

async function unpacked(name) {
  const bytes = Uint8Array.from(atob(element(name).textContent), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

// WebAssembly has addresses of 32 bits. A browser says how much memory its machine has, up to
// 8 GB, or does not: then a telephone is taken to have little.
function memory() {
  const telephone = matchMedia('(pointer: coarse)').matches && Math.min(screen.width,
                                                                       screen.height) < 600;
  const machine = navigator.deviceMemory || (telephone ? 2 : 8);
  return Math.min(4, machine / 2) * 2 ** 30;
}

function say(sentences, wrong = false) {
  element('sentences').replaceChildren(...sentences.map(sentence => {
    const item = document.createElement('li');
    item.textContent = sentence;
    return item;
  }));
  element('sentences').className = wrong ? 'wrong' : '';
}

// The sentences of the program name its options. Those that have no field here are explained.
function explained(sentences) {
  const fields = ['vertices', 'eigenvectors', 'preset', 'repair', 'no-evaluation'];
  const named = sentences.join(' ').match(/--[a-z-]+/g) || [];
  const others = named.some(option => !fields.includes(option.slice(2)));
  return others ? [...sentences, 'This page has not all options of the program: the others are ' +
                                 'those of spectral_simplify on the command line.'] : sentences;
}

function idle(status) {
  element('status').textContent = status;
  element('progress').hidden = true;
  element('cancel').disabled = true;
  element('simplify').disabled = !(mesh && mesh.vertices > 0);
}

function busy(status) {
  started = performance.now();
  element('status').textContent = status;
  element('progress').hidden = false;
  element('progress').removeAttribute('value');
  element('cancel').disabled = false;
  element('simplify').disabled = true;
  say([]);
}

const seconds = () => `${((performance.now() - started) / 1000).toFixed(1)} s`;

function startWorker() {
  const parts = ['module', 'worker'].map(name => element(name).textContent + '\n');
  const address = URL.createObjectURL(new Blob(parts, {type: 'text/javascript'}));
  worker = new Worker(address);
  URL.revokeObjectURL(address);
  worker.onmessage = event => receive(event.data);
  worker.onerror = event => fail(`The program broke down: ${event.message}.`);
  worker.postMessage({wasm, memory: memory()});
}

// A worker that broke down, or is to stop, goes with all that it has in memory.
function restart() {
  worker.terminate();
  startWorker();
}

function fail(sentence) {
  restart();
  idle('');
  say([sentence], true);
}

function receive(message) {
  if (message.phase) {
    element('status').textContent = `${message.phase.replace(/_/g, ' ')}, ${seconds()}`;
    element('progress').value = Math.max(0, Math.min(message.fraction, 1));
  } else if (message.failure)
    fail(message.failure);
  else if (message.opened)
    opened(message);
  else
    finished(message);
}

function opened({vertices, sentences}) {
  mesh.vertices = vertices;
  element('shape').textContent = mesh.name + (vertices > 0 ? `, ${grouped(vertices)} vertices` : '');
  idle(vertices > 0 ? 'Ready.' : '');
  say(explained(sentences), vertices === 0);
}

function read() {
  if (!mesh)
    return;
  mesh.vertices = 0;
  element('shape').textContent = mesh.name;
  busy('reading');
  worker.postMessage({open: {name: mesh.name, bytes: mesh.bytes,
                             repair: element('repair').checked}});
}

function take(name, bytes) {
  mesh = {name, bytes, vertices: 0};
  const extension = (name.match(/\.[^.]*$/) || [''])[0].toLowerCase();
  element('format').value = ['.off', '.obj', '.ply'].includes(extension) ? extension : '.ply';
  element('result').hidden = true;
  read();
}

// Another mesh ends what is running.
async function replace(name, bytes) {
  if (!wasm)
    return;
  if (!element('cancel').disabled)
    restart();
  busy('reading');
  try {
    take(name, await bytes());
  } catch (error) {
    idle('');
    say([`'${name}' cannot be read: ${error.message}.`], true);
  }
}

const replaceByDemonstration = () => replace(demonstration, () => unpacked('demonstration'));

function replaceByFile(file) {
  if (file)
    replace(file.name, () => file.arrayBuffer());
}

function simplify() {
  const stem = mesh.name.replace(/\.[^.]*$/, ''), format = element('format').value;
  const judge = element('judge').checked, repair = element('repair').checked;
  const fields = {input: mesh.name, output: `${stem}-coarse${format}`,
                  vertices: element('vertices').value.replace(/\s/g, ''),
                  preset: element('preset').value, repair, noEvaluation: !judge,
                  eigenvectors: element('eigenvectors').valueAsNumber || 0,
                  json: `${stem}-coarse.json`};
  if (format !== '.stl') // whose vertices have no numbers
    fields.restriction = `${stem}-coarse-P.mtx`;
  if (judge)
    fields.report = `${stem}-coarse.html`;
  const quoted = name => /^[\w.%+-]+$/.test(name) ? name : `'${name.replace(/'/g, "'\\''")}'`;
  fields.command = ['spectral_simplify', quoted(fields.input), quoted(fields.output), '--vertices',
                    quoted(fields.vertices), '--eigenvectors', fields.eigenvectors, '--preset',
                    fields.preset, ...(repair ? ['--repair'] : []),
                    ...(judge ? [] : ['--no-evaluation']),
                    ...(fields.restriction ? ['--restriction', quoted(fields.restriction)] : []),
                    ...(judge ? ['--report', quoted(fields.report)] : [])].join(' ');
  element('result').hidden = true;
  element('command').textContent = fields.command;
  busy('starting');
  worker.postMessage({simplify: fields});
}

function download(name, bytes, what) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes]));
  addresses.push(link.href);
  link.download = name;
  link.className = 'button';
  link.textContent = `${what}, ${grouped(Math.ceil(bytes.length / 1000))} kB`;
  return link;
}

// Status 3: the mesh is there, but could not be judged.
function finished({status, files, sentences}) {
  const wrong = status !== 0;
  idle(wrong ? '' : `Done in ${seconds()}.`);
  say(explained(sentences), wrong);
  const names = Object.keys(files);
  if (names.every(name => name.endsWith('.json')))
    return;
  addresses.forEach(address => URL.revokeObjectURL(address));
  addresses = [];
  const what = {mtx: 'P, MatrixMarket', html: 'Report', json: 'Figures, JSON'};
  element('downloads').replaceChildren(...names.map(name => download(
      name, files[name], what[name.split('.').pop()] || 'Mesh')));
  const report = names.find(name => name.endsWith('.html')), frame = element('report');
  frame.hidden = !report;
  element('result').hidden = false;
  frame.srcdoc = report ? new TextDecoder().decode(files[report]) : '';
}

// As high as its content, which depends on its width.
function fit() {
  const page = element('report').contentDocument;
  if (page && page.body)
    element('report').style.height = `${page.body.offsetHeight + 60}px`;
}

function listen() {
  element('form').addEventListener('submit', event => {
    event.preventDefault();
    if (!element('simplify').disabled)
      simplify();
  });
  element('cancel').addEventListener('click', () => {
    restart();
    if (mesh && mesh.vertices > 0) {
      const {name, bytes} = mesh;
      worker.postMessage({open: {name, bytes, repair: element('repair').checked}});
    } else
      mesh = null;
    idle('Cancelled.');
  });
  element('file').addEventListener('change', event => {
    replaceByFile(event.target.files[0]);
    event.target.value = '';
  });
  element('demo').addEventListener('click', replaceByDemonstration);
  element('repair').addEventListener('change', read);
  for (const name of ['dragover', 'dragleave', 'drop'])
    document.addEventListener(name, event => {
      event.preventDefault();
      element('drop').classList.toggle('over', name === 'dragover');
      if (name === 'drop')
        replaceByFile(event.dataTransfer.files[0]);
    });
  element('report').addEventListener('load', () => {
    const page = element('report').contentDocument;
    if (page && page.body)
      new ResizeObserver(fit).observe(page.body);
    fit();
  });
}

async function start() {
  listen();
  const wasmBytes = 'DecompressionStream' in window ? await unpacked('wasm') : null;
  if (!wasmBytes || !WebAssembly.validate(wasmBytes)) {
    idle('');
    say(['This browser lacks WebAssembly with vectors and exceptions: use Chrome or Edge from 95, ' +
         'Firefox from 113 or Safari from 16.4.'], true);
    return;
  }
  wasm = wasmBytes;
  startWorker();
  replaceByDemonstration();
}

start();
})();
