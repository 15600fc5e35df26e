// Kinematics of a serial arm, as in recalib.nominal.chain. A pose is the first three rows of a
// homogeneous matrix [m], as one array; angles are in rad.

const TOLERANCE = 1e-11, STEPS = 25, LONGEST_STEP = 0.5, SINGULAR = 1e9;

class Arm {
  // placements: pose of each joint, which turns about its z axis, in the frame of the previous
  // joint, and of the tool in the last joint's frame
  constructor(placements) {
    this.placements = placements;
  }

  // The tool's pose, and the joints' origins and axes.
  stand(angles) {
    const pose = Float64Array.from(this.placements[0]);
    const origins = [], directions = [];
    angles.forEach((angle, joint) => {
      const placement = this.placements[joint + 1];
      const sine = Math.sin(angle), cosine = Math.cos(angle);
      origins.push([pose[3], pose[7], pose[11]]);
      directions.push([pose[2], pose[6], pose[10]]);
      for (let row = 0; row < 12; row += 4) {
        const [x, y, z, p] = pose.slice(row, row + 4);
        const a = cosine * x + sine * y, b = cosine * y - sine * x;
        for (let column = 0; column < 4; column++)
          pose[row + column] = (column === 3 ? p : 0)
            + a * placement[column] + b * placement[4 + column] + z * placement[8 + column];
      }
    });
    return { pose, origins, directions };
  }

  forward(angles) {
    return this.stand(angles).pose;
  }

  // Angles near `start` that take the tool to `goal`, by Newton's method; null if there are none.
  inverse(goal, start) {
    let angles = start;
    for (let step = 0; step < STEPS; step++) {
      const stands = this.stand(angles), residual = difference(stands.pose, goal);
      if (largest(residual) <= TOLERANCE) return angles;
      const turn = solve(jacobian(stands), residual), longest = largest(turn);
      if (!(longest <= SINGULAR)) return null;
      const shorter = LONGEST_STEP / Math.max(LONGEST_STEP, longest);
      angles = angles.map((angle, joint) => angle + shorter * turn[joint]);
    }
    return null;
  }
}

// The motion from a pose to a goal: a translation, and the rotation axis times the angle's sine.
function difference(pose, goal) {
  const residual = [goal[3] - pose[3], goal[7] - pose[7], goal[11] - pose[11]];
  for (let row = 0; row < 3; row++) {
    const one = 4 * ((row + 1) % 3), other = 4 * ((row + 2) % 3);
    let turn = 0;
    for (let column = 0; column < 3; column++)
      turn += goal[other + column] * pose[one + column] - goal[one + column] * pose[other + column];
    residual.push(turn / 2);
  }
  return residual;
}

// Rows of the Jacobian: from joint velocities to the tool's velocity, along the base's axes.
function jacobian({ pose, origins, directions }) {
  const rows = Array.from({ length: 6 }, () => []);
  directions.forEach((direction, joint) => {
    const arm = origins[joint].map((from, axis) => pose[4 * axis + 3] - from);
    for (let row = 0; row < 3; row++) {
      const one = (row + 1) % 3, other = (row + 2) % 3;
      rows[row].push(direction[one] * arm[other] - direction[other] * arm[one]);
      rows[row + 3].push(direction[row]);
    }
  });
  return rows;
}

// Solves linear equations by elimination with pivoting; overwrites both arguments.
function solve(matrix, vector) {
  const size = vector.length;
  for (let column = 0; column < size; column++) {
    let pivot = column;
    for (let row = column + 1; row < size; row++)
      if (Math.abs(matrix[row][column]) > Math.abs(matrix[pivot][column])) pivot = row;
    [matrix[column], matrix[pivot]] = [matrix[pivot], matrix[column]];
    [vector[column], vector[pivot]] = [vector[pivot], vector[column]];
    for (let row = column + 1; row < size; row++) {
      const factor = matrix[row][column] / matrix[column][column];
      for (let other = column + 1; other < size; other++)
        matrix[row][other] -= factor * matrix[column][other];
      vector[row] -= factor * vector[column];
    }
  }
  for (let row = size - 1; row >= 0; row--) {
    for (let other = row + 1; other < size; other++)
      vector[row] -= matrix[row][other] * vector[other];
    vector[row] /= matrix[row][row];
  }
  return vector;
}

function largest(numbers) {
  return numbers.reduce((most, number) => (Math.abs(number) <= most ? most : Math.abs(number)), 0);
}
