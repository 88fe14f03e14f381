// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/offline/offline.h"

namespace telemime {

/// Compresses the image of a frame that will wait (JPEG, nearly lossless): some hundred of them may wait, and
/// those of a telephone take 25 MB each. A frame without an image, or with one that cannot be compressed,
/// stays as it is.
void put_away(OfflineFrame& frame);

/// The image of a frame is there again, where put_away() compressed it.
void take_out(OfflineFrame& frame);

}  // namespace telemime
