// Places the robot's bodies by a row of a motion: by the pose of the base and the values of the
// joints, with the tree that the page's state describes. Painted bodies have another colour than
// the rest.

import { Color, MeshLambertMaterial, Quaternion, Vector3 } from "three";

const paints = {
  wrong: new MeshLambertMaterial({ color: 0xd6261f, emissive: new Color(0x5a0d0a) }),
  old: new MeshLambertMaterial({ color: 0x9aa0a8 }),
};

export class Rig {
  /// `model` is the scene of a glTF file whose nodes carry the numbers of the bodies.
  constructor(model, config) {
    this.columns = Object.fromEntries(config.columns.map((name, i) => [name, i]));
    this.parts = config.bodies.map((body) => ({ ...body, node: null,
      column: body.joint < 0 ? -1 : this.columns["q." + config.joints[body.joint]],
      axis: new Vector3(...body.axis), place: new Vector3(...body.position),
      turn: new Quaternion(...body.quaternion) }));
    model.traverse((node) => {
      if (node.userData.body !== undefined) this.parts[node.userData.body].node = node;
    });
    this.meshes = [];
    const collect = (node, body) => {
      const own = node.userData.body ?? body;
      if (node.isMesh) this.meshes.push({ mesh: node, body: own, material: node.material });
      for (const child of node.children) collect(child, own);
    };
    collect(model, -1);
  }

  place(row) {
    const at = (name) => row[this.columns["base." + name]];
    this.parts.forEach((part, number) => {
      if (!part.node) return;
      if (number === 0) {
        part.node.position.set(at("x"), at("y"), at("z"));
        part.node.quaternion.set(at("qx"), at("qy"), at("qz"), at("qw")).normalize();
        return;
      }
      const moved = part.column < 0 ? part.offset : part.ratio * row[part.column] + part.offset;
      part.node.position.copy(part.place);
      part.node.quaternion.copy(part.turn);
      if (part.prismatic)
        part.node.position.add(part.axis.clone().multiplyScalar(moved).applyQuaternion(part.turn));
      else part.node.quaternion.multiply(new Quaternion().setFromAxisAngle(part.axis, moved));
    });
  }

  /// Paints the bodies in `wrong` red, and the others grey if the motion is older than the text.
  paint(wrong, old) {
    for (const { mesh, body, material } of this.meshes)
      mesh.material = wrong.includes(body) ? paints.wrong : old ? paints.old : material;
  }
}
