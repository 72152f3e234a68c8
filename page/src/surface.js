// The surface of the specimen as triangles and edges whose displacement is scaled, and whose values are coloured, by the
// graphics processor.

import * as three from "three";

const notMeasured = -1e30;

const moved = `
uniform float factor;
attribute vec3 displacement;
vec4 placed() { return modelViewMatrix * vec4(position + factor * displacement, 1.0); }`;

const vertexShader = `${moved}
attribute float value;
varying float shownValue;
varying vec3 place;
void main() {
  shownValue = value;
  vec4 at = placed();
  place = at.xyz;
  gl_Position = projectionMatrix * at;
}`;

// Bands of even colour with dark lines between them can be read without colour: count the lines.
const fragmentShader = `
uniform sampler2D colours;
uniform float lower;
uniform float upper;
uniform float bands;
uniform bool hasLines;
varying float shownValue;
varying vec3 place;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  float light = 0.72 + 0.28 * abs(dot(normal, normalize(vec3(0.3, 0.5, 1.0))));
  vec3 colour = vec3(0.86);
  if (shownValue > -1e29) {
    float t = (shownValue - lower) / (upper - lower) * bands;
    float band = clamp(floor(t), 0.0, bands - 1.0);
    colour = texture2D(colours, vec2((band + 0.5) / bands, 0.5)).rgb;
    float width = fwidth(t);
    float distance = abs(t - floor(t + 0.5)) / max(width, 1e-6);
    if (hasLines && width < 0.5 && floor(t + 0.5) > 0.5 && floor(t + 0.5) < bands - 0.5) {
      colour *= mix(0.45, 1.0, clamp(distance - 0.3, 0.0, 1.0));
    }
  }
  gl_FragColor = vec4(colour * light, 1.0);
}`;

const edgeShader = `${moved}
void main() { gl_Position = projectionMatrix * placed(); gl_Position.z -= 0.0004 * gl_Position.w; }`;

function textureOf(colours) {
  const data = new Uint8Array(colours.flatMap((colour) => [...colour, 255]));
  const texture = new three.DataTexture(data, colours.length, 1);
  texture.needsUpdate = true;
  return texture;
}

// The corners of the triangles of each facet, as places in the list of facets.
function cornersOf(facets, numCorners) {
  const corners = [];
  for (let first = 0; first < facets.length; first += numCorners) {
    for (let k = 2; k < numCorners; ++k) {
      corners.push(first, first + k - 1, first + k);
    }
  }
  return corners;
}

function edgesOf(facets, numCorners) {
  const seen = new Set();
  const edges = [];
  for (let first = 0; first < facets.length; first += numCorners) {
    for (let k = 0; k < numCorners; ++k) {
      const a = facets[first + k];
      const b = facets[first + ((k + 1) % numCorners)];
      const name = a < b ? `${a} ${b}` : `${b} ${a}`;
      if (!seen.has(name)) {
        seen.add(name);
        edges.push(a, b);
      }
    }
  }
  return edges;
}

const vectorsAt = (vectors, nodes) => Float32Array.from({ length: 3 * nodes.length }, (_, i) => vectors[3 * nodes[Math.floor(i / 3)] + (i % 3)]);

/** Draws facets of `numCorners` nodes, with positions of three numbers for each node. */
export class Surface {
  constructor({ nodes, facets, numCorners }) {
    this.factor = { value: 0 };
    this.corners = cornersOf(facets, numCorners);
    this.numCorners = numCorners;
    this.cornerNodes = this.corners.map((corner) => facets[corner]);
    this.edgeNodes = edgesOf(facets, numCorners);
    this.uniforms = {
      factor: this.factor,
      colours: { value: null },
      lower: { value: 0 },
      upper: { value: 1 },
      bands: { value: 1 },
      hasLines: { value: true },
    };
    const { factor } = this;
    const faces = new three.ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader,
      fragmentShader,
      side: three.DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const lines = new three.ShaderMaterial({
      uniforms: { factor },
      vertexShader: edgeShader,
      fragmentShader: "void main() { gl_FragColor = vec4(0.15, 0.15, 0.2, 0.35); }",
      transparent: true,
    });
    this.faces = new three.Mesh(this.#geometry(nodes, this.cornerNodes), faces);
    this.edges = new three.LineSegments(this.#geometry(nodes, this.edgeNodes), lines);
    for (const object of [this.faces, this.edges]) {
      object.frustumCulled = false;
    }
  }

  #geometry(nodes, places) {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(vectorsAt(nodes, places), 3));
    return geometry;
  }

  /** Takes the displacement of each node. */
  setDisplacement(displacement) {
    this.faces.geometry.setAttribute("displacement", new three.BufferAttribute(vectorsAt(displacement, this.cornerNodes), 3));
    this.edges.geometry.setAttribute("displacement", new three.BufferAttribute(vectorsAt(displacement, this.edgeNodes), 3));
  }

  /** Shows a value of each node or of each facet; NaN is grey.  `bands` has the ends of the bands and their colours. */
  setValues(values, isOfNodes, { lower, upper, colours, hasLines }) {
    const places = isOfNodes ? this.cornerNodes : this.corners.map((corner) => Math.floor(corner / this.numCorners));
    const shown = Float32Array.from(places, (place) => (Number.isFinite(values[place]) ? values[place] : notMeasured));
    this.faces.geometry.setAttribute("value", new three.BufferAttribute(shown, 1));
    this.uniforms.colours.value = textureOf(colours);
    this.uniforms.lower.value = lower;
    this.uniforms.upper.value = upper;
    this.uniforms.bands.value = colours.length;
    this.uniforms.hasLines.value = hasLines;
  }
}
