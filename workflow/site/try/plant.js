// A damaged robot with the controller of the intact robot, as in recalib.nominal.workspace
// and recalib.damaged. Commands and achieved poses are coordinates u of the workspace, in [-1, 1]^6.

class Workspace {
  constructor(centre, halfRanges) {
    Object.assign(this, { centre, halfRanges });
  }

  // R = R_centre Rz(yaw) Ry(pitch) Rx(roll)
  toPose(u) {
    const [x, y, z, ...angles] = u.map((number, axis) => number * this.halfRanges[axis]);
    const [a, b, c] = angles.map(Math.cos), [d, e, f] = angles.map(Math.sin);
    const turn = [
      [c * b, c * e * d - f * a, c * e * a + f * d],
      [f * b, f * e * d + c * a, f * e * a - c * d],
      [-e, b * d, b * a],
    ];
    return [x, y, z].flatMap((along, row) => [
      ...[0, 1, 2].map(column =>
        turn.reduce((sum, entries, k) => sum + this.centre[4 * row + k] * entries[column], 0)),
      this.centre[4 * row + 3] + along,
    ]);
  }

  toCoordinates(pose) {
    const turn = relative(this.centre, pose);
    return [
      ...[3, 7, 11].map(at => pose[at] - this.centre[at]),
      Math.atan2(turn[2][1], turn[2][2]),
      Math.atan2(-turn[2][0], Math.hypot(turn[0][0], turn[1][0])),
      Math.atan2(turn[1][0], turn[0][0]),
    ].map((number, axis) => number / this.halfRanges[axis]);
  }
}

// The rotation from the orientation of one pose to that of another.
function relative(from, to) {
  return [0, 1, 2].map(row => [0, 1, 2].map(column =>
    [0, 4, 8].reduce((sum, k) => sum + from[k + row] * to[k + column], 0)));
}

// Position [cm] and orientation error [degrees].
function errors(achieved, desired) {
  const turn = relative(desired, achieved);
  const sines = [[2, 1], [0, 2], [1, 0]].map(([i, j]) => turn[i][j] - turn[j][i]);
  const angle = Math.atan2(Math.hypot(...sines), turn[0][0] + turn[1][1] + turn[2][2] - 1);
  return [
    100 * Math.hypot(...[3, 7, 11].map(at => achieved[at] - desired[at])),
    angle * 180 / Math.PI,
  ];
}

// The controller uses the intact arm; Newton's method starts from the joint angles `near`, or home.
class Controller {
  constructor({ placements, home, lower, upper, half_ranges }) {
    Object.assign(this, { home, lower, upper });
    this.arm = new Arm(placements);
    this.workspace = new Workspace(this.arm.forward(home), half_ranges);
  }

  // Joint angles that the controller chooses for a command; null if it refuses the command.
  angles(command, near) {
    return this.within(this.arm.inverse(this.workspace.toPose(command), near ?? this.home));
  }

  within(angles) {
    const inside = angles?.every((angle, j) => this.lower[j] <= angle && angle <= this.upper[j]);
    return inside ? angles : null;
  }
}

// links: names, and indices of the placements at their ends; damage: length [m] taken off each
// link, then the true angle of each joint minus the angle that its encoder reports [rad].
class Plant {
  constructor(controller, links, damage) {
    const { placements } = controller.arm, shortened = [...placements];
    links.forEach(([, end], index) => {
      const at = placements[end], whole = Math.hypot(at[3], at[7], at[11]);
      const left = 1 - damage[index] / whole;
      shortened[end] = at.map((number, k) => (k % 4 === 3 ? left * number : number));
    });
    this.controller = controller;
    this.arm = new Arm(shortened);
    this.offsets = damage.slice(links.length);
  }

  // True joint angles, given those that the controller assumes.
  standing(angles) {
    return angles.map((angle, j) => angle + this.offsets[j]);
  }

  // The pose achieved at joint angles of the controller; home if it refused.
  achieve(angles) {
    return this.arm.forward(this.standing(angles ?? this.controller.home));
  }

  // Joint angles for the controller that take this arm to a pose, if its damage is known.
  anglesFor(pose, near) {
    const standing = this.arm.inverse(pose, this.standing(near ?? this.controller.home));
    return this.controller.within(standing?.map((angle, j) => angle - this.offsets[j]) ?? null);
  }
}
