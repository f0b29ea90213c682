#!/usr/bin/env python3
"""Trains many GCNs or POTRs at once, on a GPU where there is one: folds and seeds in one program.

predictor_learning --begin writes untrained models (sizes, schedule, first weights) and their windows;
this writes the trained ones, which predictor_learning --save finds and tests:

  predictor_learning --data DIR/cmu --preset gcn --seeds 3 --begin begun/gcn
  bench/train_baselines.py begun/gcn_[123] --out trained
  predictor_learning --data DIR/cmu --preset gcn --seeds 3 --save trained/gcn --out r.csv

Networks, losses, optimisers and the choice of weights are those of core/prediction (gcn_net.cc,
potr_net.cc, train_predictor.cc): tests/core/prediction/train_baselines_test.cc compares
losses, gradients and errors. PyTorch draws batches and dropout masks. On a GPU a step is one CUDA graph.
"""

import argparse
import pathlib
import sys
import time

import torch
import torch.nn.functional as F

from baseline_data import Model, Windows, read_tensors
from baseline_nets import FUSED, NETS, bend, decoder_layer, encoder_layer, fused

BUFFERS = ("running_mean", "running_var", "num_batches_tracked", "dct", "columns.used",
           "columns.sense", "columns.mean", "columns.scale")
MOMENTUM = 0.1  # of batch norms
CLIP_EPSILON = 1e-6
WARM_UP = 3  # steps before a graph is captured
REPLAYS = 50  # between looks at the clock
ALIGNMENT = 8  # [numbers] of each parameter, for matrix units


def rate_at(config, step):
    """OptimizerConfig::RateAt, of the schedules that these families have."""
    rate = config["learning_rate"]
    if config["schedule"] == "step":
        rate *= config["decay_factor"] ** (step // config["decay_every"])
    elif config["schedule"] != "constant":
        sys.exit(f"optimizer.schedule {config['schedule']}: only constant and step are known here")
    return rate * min(1, (step + 1) / config["warmup_steps"]) if config["warmup_steps"] else rate


def adam(flat, gradient, first, second, pace, beta1, beta2, epsilon, decay, decoupled, clip):
    """One step of torch.optim.Adam or AdamW, of a gradient clipped per model; `pace` is the rate, and
    the two sums of weights that the moments are divided by."""
    rate, sum1, sum2 = pace.unbind()
    if clip > 0:
        norm = gradient.norm(dim=1, keepdim=True)
        gradient = gradient * torch.where(norm > clip, clip / (norm + CLIP_EPSILON), torch.ones_like(norm))
    if decoupled:
        flat.mul_(1 - rate * decay)
    elif decay > 0:
        gradient = gradient + decay * flat
    first.mul_(beta1).add_(gradient, alpha=1 - beta1)
    second.mul_(beta2).addcmul_(gradient, gradient, value=1 - beta2)
    flat.sub_(rate / sum1 * first / ((second / sum2).sqrt() + epsilon))


class Training:
    """Models of the same sizes and schedule, which learn together."""

    def __init__(self, models, device):
        self.models, self.device = models, device
        card = models[0].card
        self.optimizer, self.trainer = models[0].config("optimizer"), models[0].config("trainer")
        if self.optimizer["type"] not in ("adam", "adamw"):
            sys.exit(f"optimizer.type {self.optimizer['type']}: only adam and adamw are known here")
        self.net = NETS[card["family"]](models[0].config(card["family"]))
        self.stack_weights()
        self.gather_windows()
        self.first, self.second = (torch.zeros_like(self.flat) for _ in range(2))
        self.schedule = torch.tensor([self.pace_at(step) for step in range(self.trainer["steps"])],
                                     device=device)
        self.step_number = torch.zeros(1, dtype=torch.int64, device=device)
        self.loss_sum = torch.zeros(len(models), device=device)
        self.best = [None] * len(models)  # (score, step, weights)
        self.done = self.reported = 0

    def stack_weights(self):
        names = self.models[0].weights.keys()
        stacked = {name: torch.stack([model.weights[name] for model in self.models]).to(self.device)
                   for name in names}
        self.parameters = [name for name in names if not name.endswith(BUFFERS)]
        self.running = [name for name in names if name.endswith(("running_mean", "running_var"))]
        self.shapes = {name: stacked[name].shape for name in names}
        # One tensor of all parameters: what the optimiser does is then a handful of operations.
        self.flat = torch.cat([F.pad(stacked[name].flatten(1), (0, -self.size(name) % ALIGNMENT))
                               for name in self.parameters], 1).requires_grad_()
        self.flat_running = torch.cat([stacked[name].flatten(1) for name in self.running], 1)
        self.constants = {name: stacked[name] for name in names
                          if name not in self.parameters and name not in self.running}

    def size(self, name):
        return self.shapes[name][1:].numel()

    def named(self, flat):
        """Views of all models' parameters, or of what has their form, by name."""
        parts = flat.split([self.size(name) + -self.size(name) % ALIGNMENT for name in self.parameters], 1)
        return {name: (part if part.shape[1] == self.size(name) else part[:, :self.size(name)])
                .view(self.shapes[name]) for name, part in zip(self.parameters, parts)}

    def weights(self):
        running = self.flat_running.split([self.size(name) for name in self.running], 1)
        return {**self.constants, **self.named(self.flat),
                **{name: part.view(self.shapes[name]) for name, part in zip(self.running, running)}}

    def gather_windows(self):
        frames = self.net.past + self.net.future
        rows, self.validation = [], []
        for model in self.models:
            file = read_tensors(model.windows)
            rows.append(Windows(file, "train.", model, frames, self.net.past, self.device).rows())
            if "validation.starts" in file:
                self.validation.append(
                    Windows(file, "validation.", model, frames, self.net.past, self.device))
        counts = torch.tensor([len(row) for row in rows], device=self.device)
        self.rows = torch.cat(rows)
        self.window_counts, self.window_begins = counts[:, None], (counts.cumsum(0) - counts)[:, None]

    def pace_at(self, step):
        sums = (1 - self.optimizer[beta] ** (step + 1) for beta in ("beta1", "beta2"))
        return [rate_at(self.optimizer, step), *sums]

    def draw(self):
        drawn = torch.rand(len(self.models), self.trainer["batch_size"], device=self.device)
        index = (drawn * self.window_counts).long().minimum(self.window_counts - 1)
        return self.rows[index + self.window_begins]

    def gradients(self, rows):
        """Losses (models), and their gradients (models, parameters)."""
        losses = self.net.losses(self.weights(), rows)
        return losses.detach(), torch.autograd.grad(losses.sum(), self.flat)[0]

    def step(self):
        losses, gradient = self.gradients(self.draw())
        o = self.optimizer
        pace = self.schedule.index_select(0, self.step_number)[0]
        with torch.no_grad():
            fused(adam)(self.flat.detach(), gradient, self.first, self.second, pace,
                        o["beta1"], o["beta2"], o["epsilon"], o["weight_decay"], o["type"] == "adamw",
                        o["clip_norm"])
            seen = torch.cat([self.net.statistics[name] for name in self.running], 1)
            self.flat_running.lerp_(seen, MOMENTUM)
            self.loss_sum.add_(losses)
            self.step_number.add_(1)

    @torch.no_grad()
    def validate(self):
        w = self.weights()
        for i, windows in enumerate(self.validation):
            one = {name: value[i:i + 1] for name, value in w.items()}
            score = windows.errors(self.net.predict(one, windows.rows()[None])[0]).mean().item()
            if self.best[i] is None or score < self.best[i][0]:
                self.best[i] = (score, self.done, {name: one[name][0].clone() for name in one})

    def make_step(self):
        """A function that takes one step, and the steps already taken to get it."""
        if self.device.type != "cuda":
            return self.step, 0
        side = torch.cuda.Stream()
        side.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(side):
            for _ in range(WARM_UP):
                self.step()
        torch.cuda.current_stream().wait_stream(side)
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph):
            self.step()
        return graph.replay, WARM_UP

    def run(self, max_seconds):
        steps, every = self.trainer["steps"], self.trainer["validate_every"]
        began = time.perf_counter()
        take, self.done = self.make_step()
        ready, first = time.perf_counter(), self.done
        while self.done < steps:
            more = min(REPLAYS, steps - self.done, every - self.done % every)
            for _ in range(more):
                take()
            self.done += more
            if self.done % every == 0 or self.done == steps:
                self.validate()
                self.report((time.perf_counter() - ready) / (self.done - first))
            if self.device.type == "cuda":
                torch.cuda.synchronize()
            if max_seconds and time.perf_counter() - ready > max_seconds:
                self.validate()
                break
        print(f"{len(self.models)} models: {self.done} of {steps} steps in "
              f"{time.perf_counter() - began:.1f} s, of which {ready - began:.1f} s to begin", flush=True)

    def report(self, seconds):
        losses = (self.loss_sum / (self.done - self.reported)).tolist()
        self.loss_sum.zero_()
        self.reported = self.done
        scores = " ".join(f"{best[0]:.4f}" for best in self.best if best)
        print(f"step {self.done}  loss {sum(losses) / len(losses):.4f}  "
              f"{1e3 * seconds:.2f} ms a step  {'best ' + scores if scores else ''}", flush=True)

    def write(self, out):
        w = {name: value.detach() for name, value in self.weights().items()}
        for i, model in enumerate(self.models):
            score, best_step, weights = self.best[i] or (None, self.done, {n: w[n][i] for n in w})
            model.weights = {name: weights[name].contiguous() for name in weights}
            for name in model.weights:
                if name.endswith("num_batches_tracked"):
                    model.weights[name] = model.weights[name] + best_step
            bad = [name for name, value in model.weights.items() if not torch.isfinite(value).all()]
            if bad:
                sys.exit(f"{model.name}: {bad[0]} is not finite")
            model.card["steps"] = self.done
            if score is not None:
                model.card["scores"] = {"validation_rad": score}
            model.card["trained_on"] += ", with bench/train_baselines.py"
            model.write(out / model.name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("begun", nargs="+", type=pathlib.Path, help="folders of predictor_learning --begin")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="where to put trained ones")
    parser.add_argument("--together", type=int, default=15, help="models in one program")
    parser.add_argument("--max-seconds", type=float, default=0,
                        help="shared among programs; then models are written as they are; 0: no limit")
    parser.add_argument("--tf32", action="store_true",
                        help="multiply matrices with ten bits of mantissa, as PyTorch did on such GPUs by "
                        "default when POTR was published")
    parser.add_argument("--compile", action="store_true", help="fuse layers by torch.compile")
    args = parser.parse_args()
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.set_float32_matmul_precision("high" if args.tf32 else "highest")
    if args.compile:
        FUSED.update((function, torch.compile(function, dynamic=False))
                     for function in (bend, encoder_layer, decoder_layer, adam))
    models = [Model(folder) for folder in args.begun]
    groups = [models[i:i + args.together] for i in range(0, len(models), args.together)]
    began = time.perf_counter()
    for i, group in enumerate(groups):
        left = args.max_seconds - (time.perf_counter() - began)
        torch.manual_seed(group[0].card["seed"])
        training = Training(group, device)
        training.run(max(1, left) / (len(groups) - i) if args.max_seconds else 0)
        training.write(args.out)
        del training  # before the next group takes its memory


if __name__ == "__main__":
    main()
