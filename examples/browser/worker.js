// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Runs spectral_simplify. It follows the module of Emscripten in one script; the page sends
// {wasm, memory} first, then {open} and {simplify}, and cancels by ending the worker.

'use strict';
let program = null, said = [];

// What the program says, a sentence each, without its name.
function take() {
  const sentences = said.map(line => line.replace(/^spectral_simplify: /, '').trim());
  said = [];
  return sentences.filter(line => line !== '');
}

// The program asks the files of Linux how much memory there is.
async function start({wasm, memory}) {
  program = await makeModule({
    wasmBinary: wasm,
    print: () => {}, // the table, which the report has as well
    printErr: line => said.push(line)
  });
  program.FS.writeFile('/proc/meminfo', `MemAvailable: ${Math.floor(memory / 1024)} kB\n`);
  program.FS.mkdir('/meshes');
  program.FS.chdir('/meshes');
}

function remove(names) {
  for (const name of names)
    if (program.FS.analyzePath(name).exists)
      program.FS.unlink(name);
}

function open({name, bytes, repair}) {
  remove(program.FS.readdir('.').filter(entry => entry !== '.' && entry !== '..'));
  program.FS.writeFile(name, new Uint8Array(bytes));
  const vertices = program.numberOfVertices(name, repair);
  return {opened: name, vertices, sentences: take()};
}

function simplify(fields) {
  const wanted = [fields.output, fields.restriction, fields.report, fields.json];
  const names = wanted.filter(name => name), files = {};
  remove(names);
  let last = -Infinity, shown = '';
  const status = program.simplify(fields, (phase, fraction) => {
    if (phase === shown && performance.now() - last < 100)
      return;
    last = performance.now();
    shown = phase;
    postMessage({phase, fraction});
  });
  for (const name of names)
    if (program.FS.analyzePath(name).exists)
      files[name] = program.FS.readFile(name);
  return {status, files, sentences: take()};
}

// What is no sentence of the program: a trap, such as the end of the memory.
async function answer(message) {
  try {
    if (message.wasm)
      await start(message);
    else
      postMessage(message.open ? open(message.open) : simplify(message.simplify));
  } catch (error) {
    postMessage({failure: `The program broke down: ${error && error.message || error}.`});
  }
}

let before = Promise.resolve();
onmessage = event => { before = before.then(() => answer(event.data)); };
