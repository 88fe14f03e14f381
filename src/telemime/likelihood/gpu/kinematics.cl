// SPDX-License-Identifier: Apache-2.0
// Forward kinematics of one pose, as forward_kinematics() of the body has them. A rigid transform is 12 numbers: three
// rows of the rotation, then the translation (m).

// R = Rz Rx Ry (thesis 2.4.2) as three rows.
FN void rotation_zxy(float z, float x, float y, float* r) {
  float sz, cz, sx, cx, sy, cy;
  SINE_COSINE(z, &sz, &cz);
  SINE_COSINE(x, &sx, &cx);
  SINE_COSINE(y, &sy, &cy);
  const float m10 = sx * sy;
  const float m12 = -sx * cy;
  r[0] = cz * cy - sz * m10;
  r[1] = -sz * cx;
  r[2] = cz * sy - sz * m12;
  r[3] = sz * cy + cz * m10;
  r[4] = cz * cx;
  r[5] = sz * sy + cz * m12;
  r[6] = -cx * sy;
  r[7] = sx;
  r[8] = cx * cy;
}

// R = Ry Rx Rz: the wrist.
FN void rotation_yxz(float y, float x, float z, float* r) {
  float sz, cz, sx, cx, sy, cy;
  SINE_COSINE(z, &sz, &cz);
  SINE_COSINE(x, &sx, &cx);
  SINE_COSINE(y, &sy, &cy);
  const float m20 = sx * sz;
  const float m21 = sx * cz;
  r[0] = cy * cz + sy * m20;
  r[1] = sy * m21 - cy * sz;
  r[2] = sy * cx;
  r[3] = cx * sz;
  r[4] = cx * cz;
  r[5] = -sx;
  r[6] = cy * m20 - sy * cz;
  r[7] = sy * sz + cy * m21;
  r[8] = cy * cx;
}

// out = parent * (rotation r, translation x y z).
FN void attach(const float* parent, const float* r, float x, float y, float z, float* out) {
  for (int row = 0; row < 3; ++row) {
    const float a = parent[3 * row];
    const float b = parent[3 * row + 1];
    const float c = parent[3 * row + 2];
    for (int column = 0; column < 3; ++column) {
      out[3 * row + column] = a * r[column] + b * r[3 + column] + c * r[6 + column];
    }
    out[9 + row] = a * x + b * y + c * z + parent[9 + row];
  }
}

// Transform of the chest from the root's position and its three angles; y and z of the body are opposite to the camera's.
FN void place_chest(const float* pose, float* chest) {
  float r[9];
  rotation_zxy(pose[4], pose[5], pose[3], r);
  for (int i = 0; i < 3; ++i) {
    chest[i] = r[i];
    chest[3 + i] = -r[3 + i];
    chest[6 + i] = -r[6 + i];
    chest[9 + i] = pose[i];
  }
}

FN void place_head(const float* pose, const float* chest, float x, float y, float z, float* head) {
  float r[9];
  rotation_zxy(pose[6], pose[8], pose[7], r);
  attach(chest, r, x, y, z, head);
}

// Transforms of upper arm, forearm and hand of one side. `shoulder` is the joint of a hanging arm in the chest's frame;
// it moves with the clavicle (shoulder_in_chest). Indices of pose numbers: flexion, twisting, abduction of the shoulder
// from `s` on, the elbow at `e`, and flexion, twisting, pivot of the wrist from `w` on.
FN void place_arm(const float* pose, int s, int e, int w, const float* chest, const float* shoulder, float lift,
                  float reach, float upper_length, float fore_length, float* upper, float* fore, float* hand) {
  float r[9];
  rotation_zxy(pose[s + 2], pose[s], pose[s + 1], r);
  attach(chest, r, shoulder[0], shoulder[1] + 0.5f * lift * (1.0f - r[4]),
         shoulder[2] - reach * r[7], upper);
  float sine, cosine;
  SINE_COSINE(pose[e], &sine, &cosine);
  r[0] = 1.0f;
  r[1] = r[2] = r[3] = r[6] = 0.0f;
  r[4] = r[8] = cosine;
  r[5] = -sine;
  r[7] = sine;
  attach(upper, r, 0.0f, -upper_length, 0.0f, fore);
  rotation_yxz(pose[w + 1], pose[w + 2], pose[w], r);
  attach(fore, r, 0.0f, -fore_length, 0.0f, hand);
}
