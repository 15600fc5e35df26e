// A station in another language: a simulated UR10 that is bent, behind one JSON object a line.
// recalib live "node examples/station.js" ur10_robot.urdf --tool tool0 --yes
const joints = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
  "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"];
const LINKS = [[0, Math.PI / 2, 0.1273], [-0.612, 0, 0], [-0.5723, 0, 0],  // a, alpha, d
  [0, Math.PI / 2, 0.1639], [0, -Math.PI / 2, 0.1157], [0, 0, 0.0922]];
const BENT = [0.01, -0.02, 0.015, 0.01, -0.01, 0];  // rad
const TARGET = [0.05, 0.02, 0.03];  // m, on the tool
let stands = [0, -1.2, 1.9, -2.3, -1.6, 0];

function position() {
  let [x, y, z] = TARGET;
  for (let joint = 5; joint >= 0; joint--) {
    const [a, alpha, d] = LINKS[joint], theta = stands[joint] + BENT[joint];
    const [c, s, ca, sa] = [Math.cos(theta), Math.sin(theta), Math.cos(alpha), Math.sin(alpha)];
    [x, y, z] = [x + a, ca * y - sa * z, sa * y + ca * z + d];
    [x, y] = [c * x - s * y, s * x + c * y];
  }
  const noise = () => 2e-4 * (Math.random() - 0.5);
  return { "x [m]": x + noise(), "y [m]": y + noise(), "z [m]": z + noise() };
}

const answers = {
  describe: () => ({ joints, lower: joints.map(() => -3.1), upper: joints.map(() => 3.1) }),
  move: ({ angles, speed }) => { stands = angles; return {}; },  // here your driver moves
  angles: () => ({ angles: stands }),
  measure: () => ({ row: position() }),  // { row: null } where the target is not seen
};

function stop() { /* here your driver stops the arm */ }

require("readline").createInterface({ input: process.stdin }).on("line", (line) => {
  const request = JSON.parse(line);
  if (request.do === "stop") return stop();  // it has no answer
  try {
    console.log(JSON.stringify(answers[request.do](request)));
  } catch (error) {
    console.log(JSON.stringify({ error: error.message }));
  }
}).on("close", stop);  // nobody watches any more
