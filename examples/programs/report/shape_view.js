// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The viewer of the page: WebGL 1 and nothing else. It puts a canvas in the place of each picture
// whose mesh is in the element shape-data, see shape_view.h for what that holds; where it cannot,
// the pictures stay.
(() => {
'use strict';
const element = name => document.getElementById('shape-' + name);
const data = JSON.parse(element('data').textContent);
const camera = {}; // of all panels
const chosen = {function: 0, edges: 'coarse'};
const panels = [];

function reset() {
  Object.assign(camera, {turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], zoom: 1, x: 0, y: 0});
}

// By a to the right and b down.
function turn(a, b) {
  const [c, s, d, t] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
  const by = [c, 0, s, t * s, d, -t * c, -d * s, t, d * c], R = camera.turn;
  camera.turn = by.map((_, i) => {
    const row = i - i % 3, column = i % 3;
    return by[row] * R[column] + by[row + 1] * R[3 + column] + by[row + 2] * R[6 + column];
  });
}

function zoom(factor) {
  camera.zoom = Math.min(60, Math.max(0.3, camera.zoom * factor));
}

function bytes(text) {
  const binary = atob(text), result = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i)
    result[i] = binary.charCodeAt(i);
  return result;
}

function decoded(mesh) {
  const T = bytes(mesh.triangles).buffer;
  return {P: new Uint16Array(bytes(mesh.points).buffer), T: mesh.wide ? new Uint32Array(T) : new Uint16Array(T),
          values: bytes(mesh.values)};
}

// What is drawn has no indices, which WebGL 1 limits: an entry for each corner of a triangle.
function positions(mesh, order) {
  const result = new Uint16Array(4 * order.length * mesh.T.length / 3);
  for (let f = 0, i = 0; f < mesh.T.length; f += 3)
    for (const corner of order)
      for (let c = 0; c < 4; ++c)
        result[i++] = c < 3 ? mesh.P[3 * mesh.T[f + corner] + c] : 0;
  return result;
}

function values(mesh) {
  const n = mesh.P.length / 3, first = chosen.function * n;
  return Uint8Array.from(mesh.T, v => mesh.values[first + v]);
}

// A corner has the normal of the vertex, or of the triangle where they differ by more than 40
// degrees.
function normals({P, T}) {
  const faces = new Float32Array(T.length), vertices = new Float32Array(P.length);
  for (let f = 0; f < T.length; f += 3) {
    const [a, b, c] = [3 * T[f], 3 * T[f + 1], 3 * T[f + 2]];
    const u = [0, 1, 2].map(i => P[b + i] - P[a + i]), v = [0, 1, 2].map(i => P[c + i] - P[a + i]);
    for (let i = 0; i < 3; ++i) {
      const j = (i + 1) % 3, k = (i + 2) % 3, x = u[j] * v[k] - u[k] * v[j];
      faces[f + i] = x;
      for (const vertex of [a, b, c])
        vertices[vertex + i] += x;
    }
  }
  for (const N of [faces, vertices])
    for (let i = 0; i < N.length; i += 3) {
      const length = Math.hypot(N[i], N[i + 1], N[i + 2]) || 1;
      for (let c = 0; c < 3; ++c)
        N[i + c] /= length;
    }
  const result = new Int8Array(4 * T.length);
  for (let i = 0; i < T.length; ++i) {
    const f = i - i % 3, v = 3 * T[i];
    const smooth = faces[f] * vertices[v] + faces[f + 1] * vertices[v + 1] + faces[f + 2] * vertices[v + 2] > 0.77;
    for (let c = 0; c < 3; ++c)
      result[4 * i + c] = Math.round(127 * (smooth ? vertices[v + c] : faces[f + c]));
  }
  return result;
}

// The light is that of the pictures.
const vertexShader = `
  attribute vec3 position, normal;
  attribute float value;
  uniform mat3 turn;
  uniform vec2 scale, shift;
  varying float light, at;
  void main() {
    vec3 p = turn * (2. * position - 1.);
    gl_Position = vec4(scale * p.xy + shift, -.5 * p.z, 1.);
    light = .45 + .55 * abs(dot(turn * normal, vec3(.3, .5, .81)));
    at = (value * 255. + .5) / 256.;
  }`;
const fragmentShader = `
  precision mediump float;
  uniform sampler2D colours;
  uniform float ink;
  varying float light, at;
  void main() {
    gl_FragColor = ink > 0. ? vec4(0., 0., 0., ink) : vec4(light * texture2D(colours, vec2(at, .5)).rgb, 1.);
  }`;

function programOf(gl) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  ['position', 'normal', 'value'].forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  return program;
}

// Draws a mesh on a canvas; none without WebGL.
function painter(canvas, name, mesh) {
  const gl = canvas.getContext('webgl', {alpha: false, preserveDrawingBuffer: true}); // kept for the printer
  if (!gl)
    return null;
  const program = programOf(gl), uniform = name => gl.getUniformLocation(program, name);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS))
    return null;
  const buffer = content => {
    const result = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, result);
    gl.bufferData(gl.ARRAY_BUFFER, content, gl.STATIC_DRAW);
    return result;
  };
  const attribute = (i, from, size, type, stride) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, from);
    gl.enableVertexAttribArray(i);
    gl.vertexAttribPointer(i, size, type, true, stride, 0);
  };
  const maps = data.functions.map(f => {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, bytes(f.colours));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    return texture;
  });
  const corners = mesh.T.length, points = buffer(positions(mesh, [0, 1, 2])), shading = buffer(normals(mesh));
  let edges = null, coloured = null, shown = -1;
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.polygonOffset(1, 1);
  gl.clearColor(1, 1, 1, 1);

  return () => {
    const pixels = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map(x => Math.max(1, Math.round(pixels * x)));
    if (canvas.width !== width || canvas.height !== height)
      [canvas.width, canvas.height] = [width, height];
    if (shown !== chosen.function) {
      gl.deleteBuffer(coloured);
      coloured = buffer(values(mesh));
      shown = chosen.function;
    }
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const R = camera.turn, size = camera.zoom * Math.min(width / data.half[0], height / data.half[1]);
    gl.uniformMatrix3fv(uniform('turn'), false, [R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]]);
    gl.uniform2f(uniform('scale'), size / width, size / height);
    gl.uniform2f(uniform('shift'), camera.x * size / width, camera.y * size / height);
    gl.uniform1f(uniform('ink'), 0);
    gl.bindTexture(gl.TEXTURE_2D, maps[shown]);
    attribute(0, points, 3, gl.UNSIGNED_SHORT, 8);
    attribute(1, shading, 3, gl.BYTE, 4);
    attribute(2, coloured, 1, gl.UNSIGNED_BYTE, 1);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.drawArrays(gl.TRIANGLES, 0, corners);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    if (chosen.edges !== 'both' && chosen.edges !== name)
      return;
    edges = edges || buffer(positions(mesh, [0, 1, 1, 2, 2, 0]));
    attribute(0, edges, 3, gl.UNSIGNED_SHORT, 8);
    [1, 2].forEach(i => gl.disableVertexAttribArray(i));
    gl.uniform1f(uniform('ink'), 0.2); // most edges are drawn twice
    gl.enable(gl.BLEND);
    gl.drawArrays(gl.LINES, 0, 2 * corners);
    gl.disable(gl.BLEND);
  };
}

let waiting = false;
function redraw() {
  if (!waiting)
    requestAnimationFrame(() => {
      waiting = false;
      panels.forEach(draw => draw());
    });
  waiting = true;
}

function listen(canvas) {
  const fingers = new Map();
  const unit = () => Math.min(canvas.clientWidth / data.half[0], canvas.clientHeight / data.half[1]) * camera.zoom / 2;
  const shift = (x, y) => {
    camera.x += x / unit();
    camera.y -= y / unit();
  };
  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
  });
  for (const name of ['pointerup', 'pointercancel'])
    canvas.addEventListener(name, event => fingers.delete(event.pointerId));
  canvas.addEventListener('pointermove', event => {
    const before = fingers.get(event.pointerId);
    if (!before)
      return;
    const x = event.clientX - before.clientX, y = event.clientY - before.clientY;
    fingers.set(event.pointerId, event);
    const other = [...fingers.values()].find(finger => finger.pointerId !== event.pointerId);
    if (other) {
      const apart = finger => Math.hypot(finger.clientX - other.clientX, finger.clientY - other.clientY) || 1;
      zoom(apart(event) / apart(before));
      shift(x / 2, y / 2);
    } else if (event.shiftKey)
      shift(x, y);
    else
      turn(5 * x / canvas.clientWidth, 5 * y / canvas.clientWidth);
    redraw();
  });
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 30 : 1)));
    redraw();
  }, {passive: false});
  const keys = {ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, -0.1),
                ArrowDown: () => turn(0, 0.1), '+': () => zoom(1.15), '-': () => zoom(1 / 1.15), '0': reset};
  canvas.addEventListener('keydown', event => {
    if (event.ctrlKey || event.altKey || event.metaKey || !keys[event.key])
      return;
    event.preventDefault();
    keys[event.key]();
    redraw();
  });
}

function show(mesh) {
  const picture = element(mesh.name).querySelector('img'), canvas = document.createElement('canvas');
  const draw = painter(canvas, mesh.name, decoded(mesh));
  if (!draw)
    return;
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', picture.alt);
  canvas.addEventListener('webglcontextlost', () => canvas.replaceWith(picture));
  picture.replaceWith(canvas);
  listen(canvas);
  panels.push(draw);
}

reset();
data.meshes.forEach(show);
if (panels.length === 0)
  return;
element('controls').hidden = false;
element('function').addEventListener('change', event => {
  chosen.function = event.target.selectedIndex;
  const f = data.functions[chosen.function];
  element('bar').style.background = f.gradient;
  element('shown').textContent = f.name;
  f.ticks.forEach((tick, i) => { element('ticks').children[i].textContent = tick; });
  redraw();
});
element('edges').addEventListener('change', event => {
  chosen.edges = event.target.value;
  redraw();
});
element('reset').addEventListener('click', () => {
  reset();
  redraw();
});
window.addEventListener('resize', redraw);
panels.forEach(draw => draw());
})();
