// What is drawn beside the surface: supports, loads, and the points that were measured.

import * as three from "three";

const axes = [new three.Vector3(1, 0, 0), new three.Vector3(0, 1, 0), new three.Vector3(0, 0, 1)];
const up = new three.Vector3(0, 1, 0);
const dark = 0x1c2733;
// A lightness between those of the lightest and the darkest band is seen on both.
const between = 0x1b9aaa;
// That of supports which moved, dark enough for any band.
const red = 0xb3261e;

// Draws the same shape at many places; `place(i, matrix)` says where and how large.
export class Markers {
  constructor(geometry, colour, count, place) {
    this.object = new three.InstancedMesh(geometry, new three.MeshBasicMaterial({ color: colour }), count);
    this.object.frustumCulled = false;
    this.place = place;
  }

  /** Moves all markers to where a displacement times `factor` takes them. */
  move(factor) {
    const matrix = new three.Matrix4();
    for (let i = 0; i < this.object.count; ++i) {
      this.place(i, factor, matrix);
      this.object.setMatrixAt(i, matrix);
    }
    this.object.instanceMatrix.needsUpdate = true;
  }
}

/** Returns where a node is, moved by its displacement times `factor`. */
export function movedNode(nodes, displacement, node, factor) {
  const at = (i) => nodes[3 * node + i] + factor * (displacement ? displacement[3 * node + i] : 0);
  return new three.Vector3(at(0), at(1), at(2));
}

// An arrow of length 1 along y whose tip is at the origin.
function arrowGeometry() {
  const profile = [[0, -1], [0.022, -1], [0.022, -0.3], [0.08, -0.3], [0, 0]];
  return new three.LatheGeometry(profile.map(([x, y]) => new three.Vector2(x, y)), 12);
}

/** Draws arrows that push at places, the longest with the length `size`. */
export function arrows(list, size, positionOf) {
  const largest = Math.max(...list.map(({ force }) => Math.hypot(...force)), 0);
  const directions = list.map(({ force }) => new three.Vector3(...force));
  return new Markers(arrowGeometry(), between, list.length, (i, factor, matrix) => {
    const length = size * (0.4 + (0.6 * directions[i].length()) / largest);
    const turn = new three.Quaternion().setFromUnitVectors(up, directions[i].clone().normalize());
    matrix.compose(positionOf(list[i], factor), turn, new three.Vector3(length, length, length));
  });
}

/**
 * Draws a cube at each node that is held in all directions, and a cone towards a node for each direction in which
 * another one is held, in red where the support moved.  `held` and `moved` have a bit for each component of each node,
 * and `list` the nodes that are shown.
 */
export function supports(list, { held, moved }, dimension, size, centre, positionOf) {
  const all = (1 << dimension) - 1;
  const cubes = list.filter((node) => held[node] === all).map((node) => ({ node, isMoved: moved[node] !== 0 }));
  const cones = list
    .filter((node) => held[node] !== all)
    .flatMap((node) => axes.flatMap((axis, i) => (held[node] & (1 << i) ? [{ node, axis, isMoved: (moved[node] & (1 << i)) !== 0 }] : [])));
  const cone = new three.ConeGeometry(0.5, 1, 10).translate(0, -0.5, 0);
  return [false, true].flatMap((isMoved) => {
    const colour = isMoved ? red : dark;
    const someCubes = cubes.filter((cube) => cube.isMoved === isMoved);
    const someCones = cones.filter((one) => one.isMoved === isMoved);
    return [
      new Markers(new three.BoxGeometry(0.8, 0.8, 0.8), colour, someCubes.length, (i, factor, matrix) => {
        matrix.compose(positionOf(someCubes[i].node, factor), new three.Quaternion(), new three.Vector3(size, size, size));
      }),
      new Markers(cone, colour, someCones.length, (i, factor, matrix) => {
        const { node, axis } = someCones[i];
        const at = positionOf(node, factor);
        const inwards = axis.clone().multiplyScalar(Math.sign(centre.clone().sub(at).dot(axis)) || 1);
        const turn = new three.Quaternion().setFromUnitVectors(up, inwards);
        matrix.compose(at, turn, new three.Vector3(size, size, size).multiplyScalar(1.4));
      }),
    ];
  });
}

/** Returns about `count` of the items, evenly from the list. */
export function someOf(items, count) {
  const step = Math.max(items.length / count, 1);
  return Array.from({ length: Math.min(items.length, count) }, (_, i) => items[Math.floor(i * step)]);
}

/** Draws a ball at each measured point in a colour of its own. */
export function balls(count, size, colourOfBall, positionOf) {
  const markers = new Markers(new three.SphereGeometry(0.5, 10, 8), 0xffffff, count, (i, factor, matrix) => {
    matrix.compose(positionOf(i, factor), new three.Quaternion(), new three.Vector3(size, size, size));
  });
  for (let i = 0; i < count; ++i) {
    markers.object.setColorAt(i, new three.Color(...colourOfBall(i).map((value) => value / 255)));
  }
  return markers;
}
