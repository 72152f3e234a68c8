// The specimen in three dimensions, with what to show on it, its legend, and the value under the pointer.

import * as three from "three";
import { lengths } from "./arrays.js";
import { bandsOf, colourOfBand, coloursOfValues } from "./colour_map.js";
import { html } from "./elements.js";
import { bandLegend, categoryLegend } from "./legend.js";
import { arrows, balls, movedNode, someOf, supports } from "./markers.js";
import { numberText } from "./numbers.js";
import { Stage, canDraw } from "./stage.js";
import { Surface } from "./surface.js";
import { wordsOfField } from "./words.js";

const mostSupports = 250;
// So many different values have a colour each, in place of bands.
const mostRegions = 12;
const mostValues = 6;

// Returns 1, 2 or 5 times a power of ten that is no more than the value.
function roundDown(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

const valuesOf = (values) => [...new Set(values)].filter(Number.isFinite).sort((a, b) => a - b);

function boundsOf(nodes) {
  const box = new three.Box3().setFromArray(nodes);
  return { centre: box.getCenter(new three.Vector3()), radius: box.getSize(new three.Vector3()).length() / 2 };
}

export class Viewer {
  /**
   * `labelOfRegion` tells what to write beside the colour of a region, `valueOfRegion` its modulus, and `firstField` what
   * is shown first.
   */
  constructor(specimen, { labelOfRegion, valueOfRegion, firstField }) {
    this.specimen = specimen;
    this.labelOfRegion = labelOfRegion;
    this.valueOfRegion = valueOfRegion;
    this.firstField = firstField;
    this.bounds = boundsOf(specimen.nodes);
    this.box = html("div", { class: "stage" });
    this.legend = html("div", { class: "legend" });
    this.meaning = html("p", { class: "note" });
    this.readout = html("p", { class: "readout" });
    this.keys = html("p", { class: "keys" });
    this.element = html("div", { class: "viewer" }, this.#controls(), this.box, this.legend, this.meaning, this.readout, this.keys);
    this.#showCase(0);
  }

  /** Draws the specimen, once its element is a part of the page. */
  start() {
    if (!canDraw()) {
      this.box.append(html("p", { class: "note" }, "This browser cannot draw in three dimensions (WebGL), so the specimen is not shown."));
      return;
    }
    const numNodes = this.specimen.nodes.length / 3;
    const points = [0, this.naturalFactor].flatMap((factor) =>
      Array.from({ length: numNodes }, (_, node) => this.#positionOf(node, factor)),
    );
    this.stage = new Stage(this.box, { ...this.bounds, points, isPlanar: this.specimen.dimension === 2 });
    this.surface = new Surface(this.specimen);
    this.stage.scene.add(this.surface.faces, this.surface.edges);
    this.box.addEventListener("pointermove", (event) => this.#read(event));
    this.#drawCase();
  }

  #controls() {
    const { cases } = this.specimen;
    const option = (text, value) => html("option", { value }, text);
    const check = (text, isOn) => {
      const input = html("input", { type: "checkbox", checked: isOn, onchange: () => this.#update() });
      return { input, label: html("label", { class: "check" }, input, text) };
    };
    this.fieldChoice = html("select", { id: "field", onchange: () => this.#showField() });
    this.caseChoice = html(
      "select",
      { id: "case", onchange: () => this.#showCase(Number(this.caseChoice.value)) },
      cases.map((_, i) => option(`load case ${i + 1}`, i)),
    );
    this.slider = html("input", { id: "factor", type: "range", min: 0, max: 100, value: 50, oninput: () => this.#update() });
    this.factorText = html("output", { for: "factor" });
    this.sliderTitle = html("span");
    this.sliderLabel = html("label", { class: "slider" }, this.sliderTitle, " ", this.slider, this.factorText);
    this.checks = {
      elements: check("elements", true),
      supports: check("supports", true),
      loads: check("loads", true),
      points: check("measured points", false),
    };
    return html(
      "div",
      { class: "controls" },
      html("label", {}, "show ", this.fieldChoice),
      cases.length > 1 ? html("label", {}, this.caseChoice) : null,
      this.sliderLabel,
      Object.values(this.checks).map(({ label }) => label),
    );
  }

  #fields() {
    const { points, fields } = this.loadCase;
    const ofPoints = points && !points.areNodes ? [{ name: "residual", values: lengths(points.residual), isOfPoints: true }] : [];
    return [...fields, ...ofPoints, ...this.specimen.fields];
  }

  #showCase(number) {
    this.loadCase = this.specimen.cases[number];
    const { displacement, points } = this.loadCase;
    const largest = Math.max(0, ...(displacement ? lengths(displacement) : []));
    this.naturalFactor = largest > 0 ? roundDown((0.3 * this.bounds.radius) / largest) : 0;
    if (this.naturalFactor < 2 && largest > 0) {
      this.naturalFactor = 1;
    }
    this.sliderLabel.hidden = largest === 0;
    this.sliderTitle.textContent = this.loadCase.isFitted ? "fitted displacement" : "measured displacement";
    this.#explainMarkers();
    this.checks.points.label.hidden = !points || points.areNodes;
    const before = this.fieldChoice.value || this.firstField;
    this.fields = this.#fields();
    this.fieldChoice.replaceChildren(
      ...this.fields.map(({ name }) => html("option", { value: name, selected: name === before }, wordsOfField(name).title)),
    );
    if (this.surface) {
      this.#drawCase();
    }
    this.#showField();
  }

  // Explains the markers that this load case has.
  #explainMarkers() {
    const { held, moved, loads, numCut } = this.loadCase;
    const all = (1 << this.specimen.dimension) - 1;
    const some = (masks, test) => masks.some((mask) => mask !== 0 && test(mask));
    const keys = [
      some(held, (mask) => mask === all) && "■ held in all directions",
      some(held, (mask) => mask !== all) && "▲ held in the direction in which it points",
      some(moved, () => true) && html("span", { class: "moved" }, "■ ▲ a support that moved"),
      loads.length > 0 && "→ load",
      numCut > 0 && `the measurement says that ${numCut === 1 ? "1 node" : `${numCut} nodes`} moved farther than is drawn`,
    ].filter(Boolean);
    this.keys.replaceChildren(
      ...keys.flatMap((key, i) => (i === 0 ? [key] : ["   ", key])),
      html("span", { class: "screen" }, `${keys.length > 0 ? ". " : ""}Drag to turn, scroll to zoom.`),
    );
  }

  #positionOf(node, factor) {
    return movedNode(this.specimen.nodes, this.loadCase.displacement, node, factor);
  }

  // Makes what differs between load cases.
  #drawCase() {
    const { displacement, held, moved, loads, points } = this.loadCase;
    const { nodes, dimension } = this.specimen;
    this.surface.setDisplacement(displacement ?? new Float32Array(nodes.length));
    const { radius, centre } = this.bounds;
    const nodeAt = (node, factor) => this.#positionOf(node, factor);
    const heldNodes = someOf([...held.keys()].filter((node) => held[node] !== 0), mostSupports);
    const loadAt = (load, factor) => (load.node === null ? movedNode(load.at, load.displacement, 0, factor) : nodeAt(load.node, factor));
    this.#replace({
      supports: supports(heldNodes, { held, moved }, dimension, 0.03 * radius, centre, nodeAt),
      loads: [arrows(loads, 0.28 * radius, loadAt)],
      points: points && !points.areNodes ? [this.#balls(points, () => [70, 80, 90])] : [],
    });
    this.#showField();
  }

  #balls(points, colourOfBall) {
    const at = (i, factor) => movedNode(points.positions, points.displacement, i, factor);
    return balls(points.residual.length / 3, 0.045 * this.bounds.radius, colourOfBall, at);
  }

  #replace(markers) {
    for (const [name, list] of Object.entries(markers)) {
      for (const { object } of this.markers?.[name] ?? []) {
        this.stage.scene.remove(object);
        object.dispose();
      }
      this.markers = { ...this.markers, [name]: list };
      for (const { object } of list) {
        this.stage.scene.add(object);
      }
    }
  }

  #showField() {
    this.field = this.fields.find(({ name }) => name === this.fieldChoice.value) ?? this.fields[0];
    const words = this.field ? wordsOfField(this.field.name) : null;
    this.meaning.textContent = words?.meaning ?? "";
    const isOfRegions = this.field?.name === "region";
    const categories = this.field && !this.field.isOfNodes && !this.field.isOfPoints ? valuesOf(this.field.values) : [];
    if (categories.length > 0 && categories.length <= (isOfRegions ? mostRegions : mostValues)) {
      const colours = coloursOfValues(isOfRegions ? categories.map(this.valueOfRegion) : categories);
      this.bands = { lower: -0.5, upper: categories.length - 0.5, colours, hasLines: false };
      this.shown = Float32Array.from(this.field.values, (value) => (Number.isFinite(value) ? categories.indexOf(value) : NaN));
      this.legend.replaceChildren(categoryLegend(categories.map(isOfRegions ? this.labelOfRegion : (value) => `${words.title} ${numberText(value, 5)}`), colours));
    } else {
      const ends = this.field ? bandsOf(this.field.values) : null;
      const { lower, upper, count } = ends ?? { lower: 0, upper: 1, count: 1 };
      const colours = Array.from({ length: count }, (_, band) => colourOfBand(band, count));
      this.bands = { lower, upper, colours, hasLines: this.field?.isOfNodes ?? false };
      this.shown = this.field?.values ?? [];
      this.legend.replaceChildren(...(ends ? [bandLegend(ends)] : []));
    }
    if (this.surface) {
      this.#colour();
    }
    this.#update();
  }

  #colour() {
    const isOfPoints = this.field?.isOfPoints ?? false;
    this.surface.setValues(isOfPoints ? [] : this.shown, this.field?.isOfNodes ?? true, this.bands);
    const { points } = this.loadCase;
    if (points && !points.areNodes) {
      const { lower, upper, colours } = this.bands;
      const colourOf = (value) => colours[Math.min(Math.floor(((value - lower) / (upper - lower)) * colours.length), colours.length - 1)];
      this.#replace({ points: [this.#balls(points, (i) => (isOfPoints ? colourOf(this.shown[i]) : [70, 80, 90]))] });
    }
  }

  #update() {
    this.factor = (Number(this.slider.value) / 50) * this.naturalFactor;
    this.factorText.textContent = this.factor === 1 ? "true size" : `${numberText(this.factor, 3)} times as large`;
    if (!this.surface) {
      return;
    }
    this.surface.factor.value = this.factor;
    this.surface.edges.visible = this.checks.elements.input.checked;
    for (const [name, list] of Object.entries(this.markers)) {
      const isShown = this.checks[name].input.checked || (name === "points" && (this.field?.isOfPoints ?? false));
      for (const marker of list) {
        marker.object.visible = isShown;
        marker.move(this.factor);
      }
    }
    this.stage.draw();
  }

  // Tells the value at what is nearest to the eye within a few pixels of the pointer.
  #read(event) {
    const reach = 14;
    const corner = this.box.getBoundingClientRect();
    const [x, y] = [event.clientX - corner.left, event.clientY - corner.top];
    let found = null;
    for (let i = 0; i < this.shown.length; ++i) {
      const point = this.#placeOfValue(i);
      const at = this.stage.project(point);
      if (Math.hypot(at.x - x, at.y - y) < reach && (found === null || at.depth < found.depth)) {
        found = { depth: at.depth, i, point: this.#placeOfValue(i, 0) };
      }
    }
    const coordinates = found?.point.toArray().slice(0, this.specimen.dimension).map((value) => numberText(value, 3));
    this.readout.textContent =
      found && Number.isFinite(this.field.values[found.i])
        ? `${wordsOfField(this.field.name).title} at (${coordinates.join(", ")}): ${numberText(this.field.values[found.i], 4)}`
        : "";
  }

  #placeOfValue(i, factor = this.factor) {
    const { points } = this.loadCase;
    if (this.field.isOfPoints) {
      return movedNode(points.positions, points.displacement, i, factor);
    }
    if (this.field.isOfNodes) {
      return this.#positionOf(i, factor);
    }
    const { facets, numCorners } = this.specimen;
    const centre = new three.Vector3();
    for (let k = 0; k < numCorners; ++k) {
      centre.add(this.#positionOf(facets[numCorners * i + k], factor));
    }
    return centre.divideScalar(numCorners);
  }
}
