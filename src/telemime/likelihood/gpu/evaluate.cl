// SPDX-License-Identifier: Apache-2.0
// Each group of threads evaluates one pose, with segments, vertices and z-buffer in the memory of the group. The z-buffer
// is as wide as the body; if it does not fit at once, it is drawn and read in bands of rows. The source is OpenCL C and
// CUDA: a prelude defines the macros in capitals for each. Image coordinates are pixels over 4, as in the simd kernel.

#define UNIT 0.25f
#define NEAREST 0.05f
#define THICKNESS 0.015f
#define LONGEST 4096.0f
#define CLASS_BITS 0x1fu
#define NUMBERS 23

// Lane words, written by pack_lanes().
#define LANE_SURFACE(word) ((word) & 0x1fu)
#define LANE_TOP(word) (((word) >> 5) & 1u)
#define LANE_BOTTOM(word) (((word) >> 6) & 1u)
#define LANE_IS_QUAD(word) (((word) >> 7) & 1u)
#define LANE_SEGMENT(word) (int)(((word) >> 8) & 7u)
#define LANE_STRIDE(word) (int)(((word) >> 16) & 0xffu)

#define FRONT1 1u
#define FRONT2 2u
#define KNOWN1 4u
#define KNOWN2 8u

typedef struct {
  float fx, fy, cx, cy;  // px
  int width, height;     // px
  int vertices;          // lanes and vertices of the model, at most MOST_VERTICES
  int terms;             // 1: overlap, 2: contour
  float neck[3];
  float shoulder[6];  // left, right
  float lift, reach;
  float upper_arm[2];
  float forearm[2];
} Frame;

// Counts of one pose, as the host reads them.
typedef struct {
  int model[3];
  int both[3];
  int points;
  float sum;
} PoseCounts;

FN Corner corner_of(LOCAL const float* u, LOCAL const float* v, LOCAL const float* w, int i) {
  Corner corner;
  corner.u = u[i];
  corner.v = v[i];
  corner.w = w[i];
  return corner;
}

FN void keep_transform(LOCAL float* transforms, int segment, const float* transform) {
  for (int k = 0; k < 12; ++k) {
    transforms[12 * segment + k] = transform[k];
  }
}

// Part 0 is the trunk, 1 and 2 the arms.
FN void place_part(int part, GLOBAL const float* numbers, const Frame* frame, LOCAL float* transforms) {
  float pose[NUMBERS];
  for (int i = 0; i < NUMBERS; ++i) {
    pose[i] = numbers[NUMBERS * POSE + i];
  }
  float chest[12], upper[12], fore[12], hand[12];
  place_chest(pose, chest);
  if (part == 0) {
    keep_transform(transforms, 0, chest);
    place_head(pose, chest, frame->neck[0], frame->neck[1], frame->neck[2], upper);
    keep_transform(transforms, 1, upper);
    return;
  }
  const int side = part - 1;
  float shoulder[3];
  for (int i = 0; i < 3; ++i) {
    shoulder[i] = frame->shoulder[3 * side + i];
  }
  place_arm(pose, 9 + 3 * side, 15 + side, 17 + 3 * side, chest, shoulder, frame->lift, frame->reach,
            frame->upper_arm[side], frame->forearm[side], upper, fore, hand);
  keep_transform(transforms, 2 + side, upper);
  keep_transform(transforms, 4 + side, fore);
  keep_transform(transforms, 6 + side, hand);
}

// Which triangles of the quadrilateral are in front of the camera and face it. At the ends there is only one.
FN unsigned int facing_of(const Corner* a, const Corner* b, const Corner* c, const Corner* d, unsigned int word) {
  const int inner = b->w != 0.0f && c->w != 0.0f;
  const int known1 = inner && a->w != 0.0f;
  const int known2 = inner && d->w != 0.0f;
  const int front1 = known1 && doubled_area(a, b, c) < 0.0f;
  const int front2 = known2 && doubled_area(b, d, c) < 0.0f;
  const unsigned int first = (front1 ? FRONT1 : 0u) | (known1 ? KNOWN1 : 0u);
  const unsigned int second = (front2 ? FRONT2 : 0u) | (known2 ? KNOWN2 : 0u);
  if (LANE_TOP(word)) {
    return second | (second >> 1);
  }
  if (LANE_BOTTOM(word)) {
    return first | (first << 1);
  }
  return first | second;
}

FN void draw_quad(const Corner* a, const Corner* b, const Corner* c, const Corner* d, unsigned int facing,
                  unsigned int surface, int left, int right, int top, int bottom, LOCAL unsigned int* depth) {
  const int front1 = (facing & FRONT1) != 0u;
  const int front2 = (facing & FRONT2) != 0u;
  const Corner p = front1 ? *a : *b;
  const Corner q = front2 ? *d : *c;
  const float scale = 1.0f / UNIT;
  const float low_u = FMIN(FMIN(p.u, q.u), FMIN(b->u, c->u));
  const float high_u = FMAX(FMAX(p.u, q.u), FMAX(b->u, c->u));
  const float low_v = FMIN(FMIN(p.v, q.v), FMIN(b->v, c->v));
  const float high_v = FMAX(FMAX(p.v, q.v), FMAX(b->v, c->v));
  const float low_x = FMAX(low_u * scale, (float)left);
  const float high_x = FMIN(high_u * scale, (float)right);
  const float low_y = FMAX(low_v * scale, (float)top);
  const float high_y = FMIN(high_v * scale, (float)bottom);
  if (!(low_x <= high_x && low_y <= high_y)) {
    return;
  }
  Linear edge[4];
  quad_lines(&p, b, c, &q, quad_margin(high_u - low_u, high_v - low_v), edge);
  // The plane of the larger visible triangle; beyond the diagonal that of the other one.
  const float area1 = doubled_area(a, b, c);
  const float area2 = doubled_area(b, d, c);
  const int two = area1 < 0.0f && area2 < 0.0f && front1 && front2;
  const int first = area1 < 0.0f && front1 && (!two || area1 <= area2);
  const Linear plane = depth_plane(a, b, c, d, first, 1.0f / (first ? area1 : area2));
  const Corner left_out = first ? *d : *a;
  const Linear fold = fold_line(b, c, first);
  const float bend = two ? depth_gap(&plane, &left_out) / (first ? area2 : area1) : 0.0f;
  const int x0 = (int)CEIL(low_x);
  const int x1 = (int)FLOOR(high_x);
  const int y1 = (int)FLOOR(high_y);
  for (int y = (int)CEIL(low_y); y <= y1; ++y) {
    const float v = (float)y * UNIT;
    const int row = (y - top) * (right + 1 - left) - left;
    for (int x = x0; x <= x1; ++x) {
      const float u = (float)x * UNIT;
      float least = FUSED(edge[0].b, v, FUSED(edge[0].a, u, edge[0].c));
      for (int k = 1; k < 4; ++k) {
        least = FMIN(least, FUSED(edge[k].b, v, FUSED(edge[k].a, u, edge[k].c)));
      }
      if (least >= 0.0f) {
        const float beyond = FMIN(FUSED(fold.b, v, FUSED(fold.a, u, fold.c)), 0.0f);
        const float w = FUSED(bend, beyond, FUSED(plane.b, v, FUSED(plane.a, u, plane.c)));
        if (w > 0.0f) {
          ATOMIC_MAX(&depth[row + x], (BITS_OF(w) & ~CLASS_BITS) | surface);
        }
      }
    }
  }
}

typedef struct {
  int points;
  float sum;
} Contour;

// Samples of an edge in the rows of the band.
FN Contour sample_edge(Corner a, Corner b, const Frame* frame, int left, int right, int top, int bottom,
                    LOCAL const unsigned int* depth, GLOBAL const float* distance) {
  Contour contour;
  contour.points = 0;
  contour.sum = 0.0f;
  const float scale = 1.0f / UNIT;
  const Corner d = corner_difference(&b, &a);
  const float length = scale * SQRT(d.u * d.u + d.v * d.v);
  if (!(length < LONGEST)) {
    return contour;
  }
  const int steps = length < 1.5f ? 1 : (int)(length + 0.5f);
  const float inverse = 1.0f / (float)steps;
  for (int i = 0; i < steps; ++i) {
    const float t = ((float)i + 0.5f) * inverse;
    const float x = FUSED(d.u, t, a.u) * scale;
    const float y = FUSED(d.v, t, a.v) * scale;
    if (!(x > -0.5f && y > -0.5f && x < (float)frame->width - 0.5f && y < (float)frame->height - 0.5f)) {
      continue;
    }
    const int px = (int)(x + 0.5f);
    const int py = (int)(y + 0.5f);
    if (py < top || py > bottom || px < left || px > right) {
      continue;
    }
    const float nearest = FLOAT_OF(depth[(py - top) * (right + 1 - left) + px - left]);
    if (!is_hidden(nearest, FUSED(d.w, t, a.w), THICKNESS)) {
      contour.sum += distance[py * frame->width + px];
      contour.points += 1;
    }
  }
  return contour;
}

KERNEL evaluate_poses(GLOBAL const float* poses, GLOBAL const float* vertices, GLOBAL const unsigned int* words,
                           GLOBAL const int* beside, GLOBAL const Frame* frame_of_all,
                           GLOBAL const unsigned char* labels, GLOBAL const float* distance,
                           GLOBAL PoseCounts* out) {
  SHARED float transforms[96];
  SHARED float u[MOST_VERTICES];
  SHARED float v[MOST_VERTICES];
  SHARED float w[MOST_VERTICES];
  SHARED unsigned char facing[MOST_VERTICES];
  SHARED unsigned short drawn[MOST_VERTICES];  // quadrilaterals that face the camera, in any order
  SHARED int drawn_count;
  SHARED unsigned int depth[BAND_PIXELS];
  SHARED int box[4];
  SHARED int counts[7];
  SHARED float sums_of_threads[GROUP_SIZE];

  const Frame frame = *frame_of_all;
  if (THREAD == 0) {
    box[0] = frame.width;
    box[1] = frame.height;
    box[2] = -1;
    box[3] = -1;
    drawn_count = 0;
    for (int i = 0; i < 7; ++i) {
      counts[i] = 0;
    }
  }
  // Transforms of the segments.
  for (int part = THREAD; part < 3; part += GROUP_SIZE) {
    place_part(part, poses, &frame, transforms);
  }
  SYNCHRONISE;

  // Project the vertices and find the bounding box of the body.
  int low_x = frame.width, low_y = frame.height, high_x = -1, high_y = -1;
  for (int i = THREAD; i < frame.vertices; i += GROUP_SIZE) {
    float transform[12];
    for (int k = 0; k < 12; ++k) {
      transform[k] = transforms[12 * LANE_SEGMENT(words[i]) + k];
    }
    float pu, pv, pw;
    project_vertex(transform, vertices[i], vertices[frame.vertices + i], vertices[2 * frame.vertices + i],
                   frame.fx * UNIT, frame.fy * UNIT, frame.cx * UNIT, frame.cy * UNIT, NEAREST, &pu, &pv, &pw);
    u[i] = pu;
    v[i] = pv;
    w[i] = pw;
    const float scale = 1.0f / UNIT;
    const float x = FMIN(FMAX(pu * scale, -1.0f), (float)frame.width);
    const float y = FMIN(FMAX(pv * scale, -1.0f), (float)frame.height);
    low_x = min(low_x, (int)FLOOR(x));
    low_y = min(low_y, (int)FLOOR(y));
    high_x = max(high_x, (int)CEIL(x));
    high_y = max(high_y, (int)CEIL(y));
  }
  ATOMIC_MIN(box, low_x);
  ATOMIC_MIN(box + 1, low_y);
  ATOMIC_MAX(box + 2, high_x);
  ATOMIC_MAX(box + 3, high_y);
  SYNCHRONISE;
  const int left = max(box[0], 0);
  const int first_row = max(box[1], 0);
  const int right = min(box[2], frame.width - 1);
  const int last_row = min(box[3], frame.height - 1);
  SYNCHRONISE;  // compilers load the box in one access with neighbouring words of `depth`, which the bands clear

  // Facing of the triangles, and a list of those to draw, so that all threads have something to draw.
  for (int i = THREAD; i < frame.vertices; i += GROUP_SIZE) {
    const unsigned int word = words[i];
    unsigned int f = 0u;
    if (LANE_IS_QUAD(word)) {
      const int s = LANE_STRIDE(word);
      const Corner a = corner_of(u, v, w, i);
      const Corner b = corner_of(u, v, w, i + s);
      const Corner c = corner_of(u, v, w, i + 1);
      const Corner d = corner_of(u, v, w, i + s + 1);
      f = facing_of(&a, &b, &c, &d, word);
    }
    facing[i] = (unsigned char)f;
    if ((f & (FRONT1 | FRONT2)) != 0u) {
      drawn[ATOMIC_ADD(&drawn_count, 1)] = (unsigned short)i;
    }
  }

  // Draw and count in bands of rows that fit into the memory of the group.
  int model1 = 0, model2 = 0, model3 = 0, both1 = 0, both2 = 0, both3 = 0, points = 0;
  float sum = 0.0f;
  const int span = right + 1 - left;
  const int band_rows = span > 0 ? max(BAND_PIXELS / span, 1) : 1;
  int rows = 0;  // of the band; with its end clamped instead, ptxas 13.0 compiles loops for sm_90 that leave the band
  for (int top = first_row; span > 0 && top <= last_row; top += rows) {
    rows = min(band_rows, last_row + 1 - top);
    const int bottom = top + rows - 1;
    const int pixels = rows * span;
    for (int p = THREAD; p < pixels; p += GROUP_SIZE) {
      depth[p] = 0u;
    }
    SYNCHRONISE;
    for (int k = THREAD; k < drawn_count; k += GROUP_SIZE) {
      const int i = drawn[k];
      const unsigned int word = words[i];
      const int s = LANE_STRIDE(word);
      const Corner a = corner_of(u, v, w, i);
      const Corner b = corner_of(u, v, w, i + s);
      const Corner c = corner_of(u, v, w, i + 1);
      const Corner d = corner_of(u, v, w, i + s + 1);
      draw_quad(&a, &b, &c, &d, facing[i], LANE_SURFACE(word), left, right, top, bottom, depth);
    }
    SYNCHRONISE;
    // Overlap of the band with the labels.
    if ((frame.terms & 1) != 0) {
      for (int p = THREAD; p < pixels; p += GROUP_SIZE) {
        const int surface = (int)((depth[p] & CLASS_BITS) >> 3);
        const int label = labels[(top + p / span) * frame.width + left + p % span];
        const int known = label <= 3;
        const int same = label == surface;
        model1 += surface == 1 && known ? 1 : 0;
        model2 += surface == 2 && known ? 1 : 0;
        model3 += surface == 3 && known ? 1 : 0;
        both1 += surface == 1 && same ? 1 : 0;
        both2 += surface == 2 && same ? 1 : 0;
        both3 += surface == 3 && same ? 1 : 0;
      }
    }
    // Contour samples in the rows of the band.
    if ((frame.terms & 2) != 0) {
      for (int i = THREAD; i < frame.vertices; i += GROUP_SIZE) {
        const unsigned int word = words[i];
        if (!LANE_IS_QUAD(word)) {
          continue;
        }
        const int s = LANE_STRIDE(word);
        const unsigned int f = facing[i];
        // An edge is on the contour if both its triangles are known and exactly one faces the camera.
        const unsigned int side = facing[beside[i]] >> 1;
        if (((f ^ side) & FRONT1) != 0u && (f & side & KNOWN1) != 0u) {
          const Contour part = sample_edge(corner_of(u, v, w, i), corner_of(u, v, w, i + 1), &frame, left, right, top, bottom, depth, distance);
          sum += part.sum;
          points += part.points;
        }
        if (((f ^ (f >> 1)) & FRONT1) != 0u && (f & (f >> 1) & KNOWN1) != 0u) {
          const Contour part = sample_edge(corner_of(u, v, w, i + s), corner_of(u, v, w, i + 1), &frame, left, right, top, bottom, depth, distance);
          sum += part.sum;
          points += part.points;
        }
        const unsigned int below = LANE_BOTTOM(word) ? 0u : facing[i + 1];
        if ((((f >> 1) ^ below) & FRONT1) != 0u && ((f >> 1) & below & KNOWN1) != 0u) {
          const Contour part = sample_edge(corner_of(u, v, w, i + 1), corner_of(u, v, w, i + s + 1), &frame, left, right, top, bottom,
                      depth, distance);
          sum += part.sum;
          points += part.points;
        }
      }
    }
    SYNCHRONISE;
  }

  // Add up the counts of all threads.
  ATOMIC_ADD(counts, model1);
  ATOMIC_ADD(counts + 1, model2);
  ATOMIC_ADD(counts + 2, model3);
  ATOMIC_ADD(counts + 3, both1);
  ATOMIC_ADD(counts + 4, both2);
  ATOMIC_ADD(counts + 5, both3);
  ATOMIC_ADD(counts + 6, points);
  sums_of_threads[THREAD] = sum;
  SYNCHRONISE;
  if (THREAD == 0) {
    PoseCounts result;
    for (int i = 0; i < 3; ++i) {
      result.model[i] = counts[i];
      result.both[i] = counts[3 + i];
    }
    result.points = counts[6];
    result.sum = 0.0f;  // summed in the order of threads, so that it is reproducible
    for (int i = 0; i < GROUP_SIZE; ++i) {
      result.sum += sums_of_threads[i];
    }
    out[POSE] = result;
  }
}
