#!/usr/bin/env python3
"""Time of one training step of the VAE in Python's PyTorch, beside that of poise.

Networks, losses, optimisers, batch size and lengths are those of core/synthesis/vae with the preset
`recommended`, written with PyTorch's own modules; the motions are noise. Run it under the
environment that poise gives its own programs:

  OMP_WAIT_POLICY=PASSIVE OMP_NUM_THREADS=1 OPENBLAS_CORETYPE=SkylakeX bench/vae_step.py \
      --frames 89 --lengths 40,58,... --steps 10
"""

import argparse
import random
import time

import torch
from torch import nn
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

WIDTH, LATENT, EMBEDDING, LENGTH_HIDDEN = 99, 128, 128, 32
HIDDEN = 128  # of main
CLOCK = {"frames": 6, "lstm": 4}


def two_layers(inputs, hidden, outputs):
    return nn.Sequential(nn.Linear(inputs, hidden), nn.ReLU(), nn.Linear(hidden, outputs))


def make_clock(frames, frequencies):
    turns = 2.0 ** torch.arange(frequencies)
    angles = torch.pi / frames * torch.arange(frames)[:, None] * turns[None]
    return torch.cat([angles.sin(), angles.cos()], 1)


class FrameLayers(nn.Module):
    """Two layers that see one frame and the clock."""

    def __init__(self, clock):
        super().__init__()
        self.ticks = clock
        self.first = nn.Linear(EMBEDDING, HIDDEN)
        self.clock = nn.Linear(clock.shape[1], HIDDEN, bias=False)
        self.second = nn.Linear(HIDDEN, HIDDEN)

    def forward(self, inputs):
        return torch.relu(self.second(torch.relu(self.first(inputs) + self.clock(self.ticks))))


class Reader(nn.Module):
    """What encoder and sequence discriminator read of each frame."""

    def __init__(self, frames, layers):
        super().__init__()
        self.norm = nn.LayerNorm((frames, WIDTH))
        self.is_lstm = layers == "lstm"
        if self.is_lstm:
            self.outputs = 2 * HIDDEN
            self.embed = nn.Linear(WIDTH, EMBEDDING)
            self.lstm = nn.LSTM(EMBEDDING, HIDDEN, batch_first=True, bidirectional=True)
        else:
            self.outputs = HIDDEN
            self.embed = nn.Linear(2 * WIDTH, EMBEDDING)
            self.layers = FrameLayers(make_clock(frames, CLOCK[layers]))

    def forward(self, poses, lengths):
        normed = self.norm(poses)
        if self.is_lstm:
            inputs = torch.relu(self.embed(normed))
            packed = pack_padded_sequence(inputs, lengths, batch_first=True, enforce_sorted=False)
            return pad_packed_sequence(self.lstm(packed)[0], batch_first=True, total_length=poses.shape[1])[0]
        change = 10 * (torch.cat([normed[:, 1:], normed[:, -1:]], 1) - normed)
        said = self.layers(torch.relu(self.embed(torch.cat([normed, change], 2))))
        return said * (torch.arange(poses.shape[1])[None] < lengths[:, None]).float()[..., None]


class Vae(nn.Module):
    def __init__(self, frames, layers):
        super().__init__()
        self.frames = frames
        self.reader = Reader(frames, layers)
        self.mean = two_layers(self.reader.outputs, HIDDEN, LATENT)
        self.log_variance = two_layers(self.reader.outputs, HIDDEN, LATENT)
        self.embed = nn.Linear(LATENT, EMBEDDING)
        self.is_lstm = layers == "lstm"
        self.clock = make_clock(frames, CLOCK[layers])
        if self.is_lstm:
            self.lstm = nn.LSTM(EMBEDDING + 2 * CLOCK[layers], HIDDEN, batch_first=True)
        else:
            self.layers = FrameLayers(self.clock)
        self.pose = two_layers(HIDDEN, EMBEDDING, WIDTH)
        self.length = two_layers(LATENT, LENGTH_HIDDEN, 1)

    def encode(self, poses, lengths):
        average = self.reader(poses, lengths).sum(1) / lengths[:, None]
        return self.mean(average), self.log_variance(average)

    def decode(self, z):
        inputs = torch.relu(self.embed(z))[:, None]
        if not self.is_lstm:
            return self.pose(self.layers(inputs))
        clock = self.clock[None].expand(z.shape[0], -1, -1)
        inputs = inputs.expand(-1, self.frames, -1)
        return self.pose(self.lstm(torch.cat([inputs, clock], 2))[0])


class SequenceDiscriminator(nn.Module):
    def __init__(self, frames, layers):
        super().__init__()
        self.reader = Reader(frames, layers)
        self.verdict = two_layers(self.reader.outputs, EMBEDDING, 1)

    def forward(self, poses, lengths):
        outputs = self.reader(poses, lengths)
        if not self.reader.is_lstm:
            return self.verdict(outputs.sum(1) / lengths[:, None])
        last = (lengths - 1).view(-1, 1, 1).expand(-1, 1, HIDDEN)
        forward = outputs[..., :HIDDEN].gather(1, last).squeeze(1)
        return self.verdict(torch.cat([forward, outputs[:, 0, HIDDEN:]], 1))


def decode_columns(poses):
    columns = poses[..., 3:].reshape(*poses.shape[:2], -1, 2, 3)
    a, b = columns[..., 0, :], columns[..., 1, :]
    x = a / a.norm(dim=-1, keepdim=True).clamp_min(1e-8)
    y = b - (x * b).sum(-1, keepdim=True) * x
    y = y / y.norm(dim=-1, keepdim=True).clamp_min(1e-8)
    return poses[..., :3], torch.stack([x, y, torch.cross(x, y, dim=-1)], -1)


def masked_mean(positions, rotations, valid):
    per_frame = positions.square().sum(-1) + rotations.square().sum((-3, -2, -1))
    return ((per_frame * valid).sum(1) / valid.sum(1).clamp_min(1)).mean()


def second_difference(x):
    return x[:, 2:] - 2 * x[:, 1:-1] + x[:, :-2]


def hinge(real, made):
    return 0.5 * (torch.relu(1 - real).mean() + torch.relu(1 + made).mean())


class Loop:
    def __init__(self, frames, lengths, batch, layers):
        torch.manual_seed(1)
        self.frames, self.lengths, self.batch = frames, lengths, batch
        self.vae = Vae(frames, layers)
        self.frame_judge = two_layers(WIDTH, EMBEDDING, 1)
        self.sequence_judge = SequenceDiscriminator(frames, layers)
        self.vae_optimizer = torch.optim.Adam(self.vae.parameters(), 1e-3)
        self.optimizers = [torch.optim.Adam(net.parameters(), 1e-4, (0.5, 0.999))
                           for net in (self.frame_judge, self.sequence_judge)]
        self.motions = torch.randn(len(lengths), frames, WIDTH)

    def step(self):
        chosen = torch.tensor([random.randrange(len(self.lengths)) for _ in range(self.batch)])
        poses, lengths = self.motions[chosen], torch.tensor(self.lengths)[chosen]
        valid = (torch.arange(self.frames)[None] < lengths[:, None]).float()
        mean, log_variance = self.vae.encode(poses, lengths)
        z = mean + (0.5 * log_variance).exp() * torch.randn_like(mean)
        made = self.vae.decode(z)
        length = self.frames - self.vae.length(z).squeeze(1)
        made_lengths = length.detach().round().clamp(1, self.frames).long()
        positions, rotations = decode_columns(made)
        real_positions, real_rotations = decode_columns(poses)
        terms = [
            masked_mean(real_positions - positions, real_rotations - rotations, valid),
            0.001 * masked_mean(second_difference(positions), second_difference(rotations), valid[:, 2:]),
            0.005 * (mean.square() + log_variance.exp() - 1 - log_variance).sum(1).mean(),
            0.01 * (length - lengths).square().mean(),
            -0.03 * self.frame_judge(made).mean(),
            -0.03 * self.sequence_judge(made, made_lengths).mean(),
        ]
        self.vae_optimizer.zero_grad()
        sum(terms).backward()
        nn.utils.clip_grad_norm_(self.vae.parameters(), 1.0)
        self.vae_optimizer.step()
        made = made.detach()
        losses = [
            lambda: hinge(self.frame_judge(poses), self.frame_judge(made)),
            lambda: hinge(self.sequence_judge(poses, lengths),
                          self.sequence_judge(made, made_lengths)),
        ]
        for loss, optimizer in zip(losses, self.optimizers):
            optimizer.zero_grad()
            loss().backward()
            optimizer.step()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--frames", type=int, required=True)
    parser.add_argument("--lengths", required=True, help="of the training motions, with commas")
    parser.add_argument("--batch", type=int, default=8)
    parser.add_argument("--steps", type=int, default=10)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--layers", choices=["frames", "lstm"], default="frames")
    parser.add_argument("--hidden", type=int, default=HIDDEN)
    args = parser.parse_args()
    globals()["HIDDEN"] = args.hidden
    torch.set_num_threads(args.threads)
    loop = Loop(args.frames, [int(length) for length in args.lengths.split(",")], args.batch,
                args.layers)
    loop.step()
    began = time.perf_counter()
    for _ in range(args.steps):
        loop.step()
    print(f"{(time.perf_counter() - began) / args.steps * 1000:.1f} ms a step")


if __name__ == "__main__":
    main()
