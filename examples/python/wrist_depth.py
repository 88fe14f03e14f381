# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# How far a wrist is from the camera, and how sure Telemime is of it.
# Usage: wrist_depth.py [PNG]. The lines "# %%" divide the file into cells for editors that run notebooks.

# %% The bundled clip, tracked.
import sys

import matplotlib
import numpy as np
import telemime

demo = telemime.demo_folder()
frames = list(telemime.track(demo / "video.mp4", background=demo / "background.mp4", seed=1))

# %% Depth from the middle of the shoulders, in millimetres: negative is toward the camera.
# The spread of a frame is a covariance (mm²) relative to that middle; its last number is the variance of the depth.
WRIST = "r_wrist"
time = np.array([frame.time for frame in frames])
middle = np.array([frame.joints["l_shoulder"] + frame.joints["r_shoulder"] for frame in frames]) / 2
depth = np.array([frame.joints[WRIST][2] for frame in frames]) - middle[:, 2]
deviation = np.array([np.nan if frame.spread is None else np.sqrt(frame.spread[WRIST][2, 2]) for frame in frames])

# %% The same of the truth, which this clip has because it is synthetic.
import json

with open(demo / "truth.json") as file:
    truth = json.load(file)
positions = np.array(truth["positions"])[[frame.number for frame in frames]]
places = dict(zip(truth["joints"], positions.swapaxes(0, 1)))
true_depth = (places[WRIST] - (places["l_shoulder"] + places["r_shoulder"]) / 2)[:, 2]

print(f"{len(frames)} frames, mean error of the depth {np.mean(np.abs(depth - true_depth)):.0f} mm")

# %% The picture.
matplotlib.use("Agg")
import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(8, 4), constrained_layout=True)
axes.fill_between(time, depth - 2 * deviation, depth + 2 * deviation, color="C0", alpha=0.2, label="± 2 standard deviations")
axes.plot(time, depth, color="C0", label="tracked")
axes.plot(time, true_depth, color="black", linewidth=1, linestyle="--", label="truth")
axes.set(xlabel="time, s", ylabel=f"depth of {WRIST}, mm", title="From the middle of the shoulders; up is toward the camera")
axes.invert_yaxis()
axes.legend(loc="best")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "wrist_depth.png", dpi=100)
