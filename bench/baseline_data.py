"""Models of predictor_learning --begin and their windows, for train_baselines.py."""

import hashlib
import json

import numpy as np
import torch

TYPES = {"F32": np.float32, "F64": np.float64, "I64": np.int64, "U8": np.uint8}
TINY = 1e-12  # keeps square roots away from 0
NEAR_GIMBAL = 1e-6
MOVING_DEVIATION = 1e-4  # [rad] of columns that the CMU error counts in a window
ROOT_COLUMNS = 6


# Files: safetensors, with the header as base::EncodeTensors writes it, which card.json's digest is of.

def read_tensors(path):
    data = path.read_bytes()
    length = int.from_bytes(data[:8], "little")
    header = json.loads(data[8:8 + length])
    header.pop("__metadata__", None)
    tensors = {}
    for name, entry in header.items():
        begin, end = (8 + length + offset for offset in entry["data_offsets"])
        numbers = np.frombuffer(data[begin:end], TYPES[entry["dtype"]]).reshape(entry["shape"])
        tensors[name] = torch.from_numpy(numbers.copy())
    return tensors


def encode_tensors(tensors):
    header, numbers, offset = {}, [], 0
    for name in sorted(tensors):
        array = tensors[name].cpu().numpy()
        data = array.tobytes()
        dtype = next(key for key, value in TYPES.items() if value == array.dtype)
        header[name] = {"dtype": dtype, "shape": list(array.shape),
                        "data_offsets": [offset, offset + len(data)]}
        numbers.append(data)
        offset += len(data)
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    return len(text).to_bytes(8, "little") + text + b"".join(numbers)


# Rotations (core/prediction/tensors/rotation_tensors.cc): quaternions (..., 4) w x y z.

def conjugate(q):
    return q * q.new_tensor([1, -1, -1, -1])


def multiply(a, b):
    aw, ax, ay, az = a.unbind(-1)
    bw, bx, by, bz = b.unbind(-1)
    return torch.stack([aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
                        aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw], -1)


def rotate(q, v):
    imaginary = q[..., 1:].expand_as(v)
    twice = 2 * torch.cross(imaginary, v, dim=-1)
    return v + q[..., :1] * twice + torch.cross(imaginary, twice, dim=-1)


def log_map(q):
    q = torch.where(q[..., :1] < 0, -q, q)
    sine = (q[..., 1:].square().sum(-1, keepdim=True) + TINY).sqrt()
    return q[..., 1:] * (2 * torch.atan2(sine, q[..., :1]) / sine)


def exp_map(v):
    half = (v.square().sum(-1, keepdim=True) + TINY).sqrt() / 2
    return torch.cat([half.cos(), v * (half.sin() / (2 * half))], -1)


def paper_euler(q, row_vectors):
    w, x, y, z = (conjugate(q) if row_vectors else q).unbind(-1)
    m00, m01, m02 = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    m12, m22 = 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    return torch.stack([torch.atan2(m12, m22), -torch.asin(m02.clamp(NEAR_GIMBAL - 1, 1 - NEAR_GIMBAL)),
                        torch.atan2(m01, m00)], -1)


class Windows:
    """Windows of one file, as rows of a model's columns: ColumnTensors and EulerMeasure."""

    def __init__(self, file, prefix, model, frames, past, device):
        self.past, self.model = past, model
        starts = file[prefix + "starts"].to(device)
        self.index = starts[:, None] + torch.arange(frames, device=device)
        self.joints = torch.tensor(model.joints, device=device)
        self.rotations = file[prefix + "rotations"].to(device)
        self.positions = file[prefix + "positions"].to(device)
        self.counts = file["counts"].to(device)
        self.row_vectors, self.moving_only = (bool(file[name]) for name in ("row_vectors", "moving_only"))
        constants = {name: model.weights["columns." + name].to(device)
                     for name in ("used", "sense", "mean", "scale")}
        self.used = constants["used"].nonzero().flatten()
        self.sense, self.mean, self.scale = (constants[name] for name in ("sense", "mean", "scale"))
        self.vectors = self.sense * log_map(self.rotations[:, self.joints]).flatten(1)

    def rows(self):
        """(windows, frames, columns)"""
        joints = self.vectors[self.index]
        root = self.rotations[:, 0][self.index]
        positions = self.positions[self.index]
        last = slice(self.past - 1, self.past)
        root_from_world = conjugate(root[:, last])
        path = rotate(root_from_world.expand_as(root), positions - positions[:, last])
        everything = torch.cat([path, log_map(multiply(root_from_world, root)), joints], -1)
        return (everything[..., self.used] - self.mean) / self.scale

    def errors(self, future):
        """Euler errors (windows, frames) of rows (windows, future, columns)."""
        everything = self.vectors[self.index[:, self.past - 1:self.past]]
        everything = everything.expand(-1, future.shape[1], -1).clone()
        of_joint = self.used >= ROOT_COLUMNS
        everything[..., self.used[of_joint] - ROOT_COLUMNS] = (future * self.scale + self.mean)[..., of_joint]
        predicted = exp_map((self.sense * everything).unflatten(-1, (len(self.joints), 3)))
        target = self.rotations[self.index[:, self.past:]][:, :, self.joints]
        wanted = paper_euler(target, self.row_vectors).flatten(2)
        difference = (paper_euler(predicted, self.row_vectors).flatten(2) - wanted) * self.counts
        if self.moving_only:
            difference = difference * (wanted.std(1, unbiased=False, keepdim=True) > MOVING_DEVIATION)
        return difference.square().sum(-1).sqrt()


class Model:
    """A folder with card.json and weights.safetensors."""

    def __init__(self, folder):
        self.name = folder.name
        self.card = json.loads((folder / "card.json").read_text())
        self.weights = read_tensors(folder / "weights.safetensors")
        self.joints = self.card["normalisation"]["body"]["joints"]
        self.windows = folder.parent / (folder.name.rsplit("_", 1)[0] + ".safetensors")

    def config(self, prefix):
        return {key[len(prefix) + 1:]: value for key, value in self.card["config"].items()
                if key.startswith(prefix + ".")}

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        data = encode_tensors(self.weights)
        self.card["weights_sha256"] = hashlib.sha256(data).hexdigest()
        (folder / "card.json").write_text(json.dumps(self.card, indent=2) + "\n")
        (folder / "weights.safetensors").write_bytes(data)
