"""Losses and gradients of bench/train_baselines.py on the first windows of begun models, for
train_baselines_test.cc.

  train_baselines_probe.py BENCH_FOLDER WINDOWS OUT BEGUN...
"""

import pathlib
import sys

import torch

sys.path.insert(0, sys.argv[1])
import baseline_data  # noqa: E402
import train_baselines  # noqa: E402

windows, out = int(sys.argv[2]), pathlib.Path(sys.argv[3])
models = [baseline_data.Model(pathlib.Path(folder)) for folder in sys.argv[4:]]
training = train_baselines.Training(models, torch.device("cpu"))
rows = torch.stack([training.rows[begin:begin + windows] for begin in training.window_begins.flatten()])
losses, gradients = training.gradients(rows)
found = {}
for name, gradient in training.named(gradients).items():
    found.update((f"{model.name}.{name}", part.contiguous()) for model, part in zip(models, gradient))
found.update((model.name + ".loss", loss.reshape(1)) for model, loss in zip(models, losses))
out.write_bytes(baseline_data.encode_tensors(found))
