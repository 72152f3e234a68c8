// The camera, the light and the canvas on which the specimen is drawn.  It draws when something has changed, and not else.

import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { svg } from "./elements.js";

// Colours go to the screen as they are in the legend.
three.ColorManagement.enabled = false;

// Heights of the canvas over its width.
const leastAspect = 0.25;
const largestAspect = 0.5;

const axisNames = ["x", "y", "z"];

/** Tells whether this browser can draw in three dimensions. */
export function canDraw() {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}

export class Stage {
  /** Shows what lies around `centre`, all of `points` within `radius` and a margin; planar specimens from above. */
  constructor(box, { centre, radius, points, isPlanar }) {
    // A print shows what was drawn last.
    this.renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = three.LinearSRGBColorSpace;
    this.renderer.setClearColor(0xffffff);
    this.scene = new three.Scene();
    this.camera = new three.OrthographicCamera(-1, 1, 1, -1, 0, 20 * radius);
    this.camera.up.set(0, isPlanar ? 1 : 0, isPlanar ? 0 : 1);
    const direction = isPlanar ? new three.Vector3(0, 0, 1) : new three.Vector3(0.55, -1, 0.5).normalize();
    this.camera.position.copy(centre).addScaledVector(direction, 10 * radius);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.target.copy(centre);
    this.controls.enableRotate = !isPlanar;
    this.controls.addEventListener("change", () => this.draw());
    this.axes = svg("svg", { viewBox: "-40 -40 80 80", class: "axes", "aria-hidden": "true" });
    this.isPlanar = isPlanar;
    box.append(this.renderer.domElement, this.axes);
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.#frame(points, 0.2 * radius);
    window.addEventListener("resize", () => this.#fit(box));
    this.#fit(box);
  }

  // Finds what the camera has to see.
  #frame(points, margin) {
    const seen = new three.Box3();
    for (const point of points) {
      seen.expandByPoint(point.applyMatrix4(this.camera.matrixWorldInverse));
    }
    this.middle = seen.getCenter(new three.Vector3());
    this.half = seen.getSize(new three.Vector3()).multiplyScalar(0.5).addScalar(margin);
  }

  #fit(box) {
    const width = box.clientWidth;
    if (width === 0) {
      return;
    }
    const { middle, half } = this;
    const height = Math.round(width * Math.min(Math.max(half.y / half.x, leastAspect), width < 600 ? 1 : largestAspect));
    this.renderer.setPixelRatio(Math.max(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    const halfHeight = Math.max(half.y, (half.x * height) / width);
    this.camera.top = middle.y + halfHeight;
    this.camera.bottom = middle.y - halfHeight;
    this.camera.right = middle.x + (halfHeight * width) / height;
    this.camera.left = middle.x - (halfHeight * width) / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Draws soon; several calls draw once. */
  draw() {
    if (!this.isWaiting) {
      this.isWaiting = true;
      requestAnimationFrame(() => this.#drawNow());
    }
  }

  #drawNow() {
    this.isWaiting = false;
    this.renderer.render(this.scene, this.camera);
    this.renderer.domElement.dataset.triangles = this.renderer.info.render.triangles;
    this.axes.replaceChildren(...axisNames.slice(0, this.isPlanar ? 2 : 3).flatMap((name, i) => this.#axis(name, i)));
  }

  #axis(name, i) {
    const end = new three.Vector3().setComponent(i, 1).transformDirection(this.camera.matrixWorldInverse);
    const [x, y] = [24 * end.x, -24 * end.y];
    return Math.hypot(x, y) < 4
      ? []
      : [svg("line", { x1: 0, y1: 0, x2: x, y2: y, class: "axis" }), svg("text", { x: 1.35 * x, y: 1.35 * y + 4, class: "tick middle" }, name)];
  }

  /** Returns the place on the canvas of a point of the specimen, and its depth. */
  project(point) {
    const { width, height } = this.renderer.domElement.getBoundingClientRect();
    const at = point.clone().project(this.camera);
    return { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height, depth: at.z };
  }
}
