// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/face_measures.h"
#include "telemime/body/face_motion.h"
#include "telemime/core/camera.h"

namespace telemime {

/// The coefficients and the gaze of a face from its measures and those of the same face at rest; docs/face.md
/// has the formula of each. All are finite, whatever the measures.
FaceMotion expression_of(const FaceMeasures& seen, const FaceMeasures& neutral);

/// How the head is held, where the eyes look and what the face does. `points` are in pixels of the camera's
/// picture, `presence` is the probability that they are a face, `time` in s. Learns the person's face at rest
/// from what is clearly seen, from the front and from both sides. What is turned away from the camera does
/// what the other side does.
/// Confidence is 0, and everything at rest, if the points are no face.
FaceMotion face_motion(const FacePoints& points, double presence, const Camera& camera, double time,
                       NeutralFace& neutral);

/// One face from two looks at the same picture: head, gaze and expressions are the mean of both, with the
/// difference of gaze and expressions as noise. A look that shows no face does not count.
FaceMotion mean_of_looks(const FaceMotion& first, const FaceMotion& second);

/// The face in a mirror, the plane x = 0 of the camera frame.
FaceMotion mirrored(const FaceMotion& face);

}  // namespace telemime
