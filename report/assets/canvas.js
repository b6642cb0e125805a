// Draws lines of vertices by WebGL2, or on a plain canvas where there is none.
'use strict';

const RAMP = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

function rampAt(share) {
  const at = Math.min(1, Math.max(0, share)) * 4, i = Math.min(3, Math.floor(at)), f = at - i;
  return RAMP[i].map((x, k) => Math.round(x + (RAMP[i + 1][k] - x) * f));
}

const VERTEX = `#version 300 es
in vec3 place; in float value;
uniform mat3 turn; uniform vec3 middle; uniform vec2 scale; uniform float top; uniform float size; uniform vec2 aside;
out float share;
void main() {
  vec3 q = turn * (place - middle);
  gl_Position = vec4(q.xy * scale + aside, 0.0, 1.0);
  share = value < 0.0 ? -1.0 : value / top;
  gl_PointSize = size;
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in float share; uniform vec4 flatColour; uniform vec4 rapidColour; out vec4 colour;
vec3 ramp(float t) {
  vec3 a = vec3(.267,.004,.329), b = vec3(.231,.322,.545), c = vec3(.129,.569,.549);
  vec3 d = vec3(.369,.788,.384), e = vec3(.992,.906,.145);
  t = clamp(t, 0., 1.) * 4.;
  return t < 1. ? mix(a, b, t) : t < 2. ? mix(b, c, t - 1.) : t < 3. ? mix(c, d, t - 2.) : mix(d, e, t - 3.);
}
void main() {
  colour = flatColour.a > 0. ? flatColour : share < 0. ? rapidColour : vec4(ramp(share), 1.);
}`;

const WIDE_MOST = 100000; // vertices of a line that is drawn wider

class GlCanvas {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) return;
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    this.at = {};
    for (const name of ['turn', 'middle', 'scale', 'top', 'size', 'aside', 'flatColour', 'rapidColour']) {
      this.at[name] = gl.getUniformLocation(program, name);
    }
    this.place = gl.getAttribLocation(program, 'place');
    this.value = gl.getAttribLocation(program, 'value');
    this.point = gl.createBuffer();
  }
  // Gives the vertices to the graphics card.
  load(mesh) {
    const gl = this.gl, places = gl.createBuffer(), values = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, places);
    gl.bufferData(gl.ARRAY_BUFFER, mesh.xyz, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, values);
    gl.bufferData(gl.ARRAY_BUFFER, mesh.values, gl.STATIC_DRAW);
    return { mesh, places, values };
  }
  drop(loaded) {
    this.gl.deleteBuffer(loaded.places);
    this.gl.deleteBuffer(loaded.values);
  }
  begin(camera, dark) {
    const gl = this.gl, { canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    const back = dark ? [0.07, 0.086, 0.11] : [1, 1, 1];
    gl.clearColor(...back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.uniformMatrix3fv(this.at.turn, false, camera.columns());
    gl.uniform3fv(this.at.middle, camera.middle);
    const ratio = devicePixelRatio;
    gl.uniform2f(this.at.scale, 2 * camera.scale * ratio / canvas.width, 2 * camera.scale * ratio / canvas.height);
    gl.uniform1f(this.at.size, 11 * ratio);
    this.dark = dark;
  }
  line(loaded, value, top, flat) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, loaded.places);
    gl.enableVertexAttribArray(this.place);
    gl.vertexAttribPointer(this.place, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, loaded.values);
    gl.enableVertexAttribArray(this.value);
    gl.vertexAttribPointer(this.value, 1, gl.FLOAT, false, 4 * VALUES, 4 * value);
    gl.uniform1f(this.at.top, top > 0 ? top : 1);
    gl.uniform4fv(this.at.flatColour, flat ? [...flat.map(x => x / 255), 1] : [0, 0, 0, 0]);
    gl.uniform4fv(this.at.rapidColour, this.dark ? [0.35, 0.39, 0.45, 1] : [0.75, 0.78, 0.82, 1]);
    // Lines of WebGL are one pixel wide: short ones are drawn three times, a pixel aside.
    const asides = loaded.mesh.count < WIDE_MOST ? [[0, 0], [1, 0], [0, 1]] : [[0, 0]];
    for (const [x, y] of asides) {
      gl.uniform2f(this.at.aside, 2 * x / this.canvas.width, 2 * y / this.canvas.height);
      gl.drawArrays(gl.LINE_STRIP, 0, loaded.mesh.count);
    }
    gl.uniform2f(this.at.aside, 0, 0);
  }
  dot(place, colour) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.point);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(place), gl.DYNAMIC_DRAW);
    gl.vertexAttribPointer(this.place, 3, gl.FLOAT, false, 0, 0);
    gl.disableVertexAttribArray(this.value);
    gl.uniform4fv(this.at.flatColour, [...colour.map(x => x / 255), 1]);
    gl.drawArrays(gl.POINTS, 0, 1);
  }
}

const PLAIN_STEPS = 24; // colours of the plain canvas
const PLAIN_MOST = 60000; // vertices of a line on it

class PlainCanvas {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }
  load(mesh) { return { mesh }; }
  drop() {}
  begin(camera, dark) {
    const { context, canvas } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = dark ? '#12161c' : '#fff';
    context.fillRect(0, 0, canvas.width, canvas.height);
    this.camera = camera;
    this.dark = dark;
    context.lineWidth = devicePixelRatio;
  }
  screen(x, y, z) {
    const [a, b] = this.camera.project([x, y, z]);
    return [a * devicePixelRatio, b * devicePixelRatio];
  }
  line(loaded, value, top, flat) {
    const { mesh } = loaded, { context } = this, by = Math.max(1, Math.ceil(mesh.count / PLAIN_MOST));
    const groups = new Map();
    for (let i = by; i < mesh.count; i += by) {
      const x = mesh.values[VALUES * i + value];
      const key = flat ? 0 : x < 0 ? -1 : Math.round(PLAIN_STEPS * Math.min(1, x / (top > 0 ? top : 1)));
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(i);
    }
    for (const [key, list] of groups) {
      const rgb = flat ?? (key < 0 ? (this.dark ? [90, 100, 115] : [190, 198, 208]) : rampAt(key / PLAIN_STEPS));
      context.strokeStyle = `rgb(${rgb})`;
      context.beginPath();
      for (const i of list) {
        const j = i - by;
        context.moveTo(...this.screen(mesh.xyz[3 * j], mesh.xyz[3 * j + 1], mesh.xyz[3 * j + 2]));
        context.lineTo(...this.screen(mesh.xyz[3 * i], mesh.xyz[3 * i + 1], mesh.xyz[3 * i + 2]));
      }
      context.stroke();
    }
  }
  dot(place, colour) {
    const { context } = this, [x, y] = this.screen(...place);
    context.fillStyle = `rgb(${colour})`;
    context.beginPath();
    context.arc(x, y, 5.5 * devicePixelRatio, 0, 7);
    context.fill();
  }
}

function canvasFor(canvas) {
  const asked = new URLSearchParams(location.hash.slice(1)).has('plain');
  if (!asked) {
    const drawn = new GlCanvas(canvas);
    if (drawn.gl) return drawn;
  }
  return new PlainCanvas(canvas);
}
