// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/body.h"

namespace telemime {

/// How rare this pose of both arms is among people in motion: the squared Mahalanobis distance of the
/// directions of upper arms and forearms in the frame of the chest from their mean in motion capture. Both
/// arms count together, since they move together. The mean over the data is about 11, the mirror image of a
/// pose has the same value. Data: CMU Graphics Lab Motion Capture Database and Microsoft LabanotationSuite,
/// 32 minutes of 27 people who gesture, dance, walk and do sports, each frame also mirrored.
double arm_rarity(const Kinematics& kinematics);

}  // namespace telemime
