"""Multi-object tracker: association, filtering, classification, birth and death of tracks.

Every track has an IMM filter, whose mode probabilities classify it as static or moving. A lost
track that may move becomes a particle filter. Association uses colour and position only.
"""

from math import log, pi

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record
from navigation.belief import imm, particles
from navigation.belief.association import assign, association_costs, distinct
from navigation.belief.detections import Detections
from navigation.belief.tracked_object import (
    ObjectRecord,
    begin,
    correct,
    position_of,
    published,
    search_radius,
)
from navigation.belief.tracks import STATIC, UNKNOWN, VX, WEIGHT, Tracks, X, Y
from navigation.belief.visibility import (
    Mask,
    Viewpoint,
    clearly_visible,
    in_view,
    occluded,
    relative_discs,
)
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Rows = NDArray[np.record]

KEPT, DELETED, SPAWNS, REFUTED = range(4)  # of a track after a frame without its detection


class Tracker:
    """Multi-object tracker of the obstacles.

    Args:
        parameters: motion models, association, classification, birth and death.
        rng: source of the particles.
    """

    def __init__(self, parameters: TrackingParameters, rng: np.random.Generator) -> None:
        self._parameters = parameters
        self._record = record(parameters)
        self._rng = rng
        # Costs of a track birth on unseen floor and on floor seen empty.
        self._birth_cost = 2.0 * log(2.0 * pi * parameters.birth_density)
        self._intruder_cost = 2.0 * log(2.0 * pi * parameters.intruder_density)
        self._labels: list[str] = []
        self._time: float | None = None
        self._next_id = 1
        self.clear()

    def clear(self) -> None:
        """Delete all tracks."""
        self._objects: Rows = np.zeros(0, ObjectRecord)
        self._clouds: Array = np.zeros((0, 6, self._parameters.particles))

    def update(
        self, time: float, detections: Detections, viewpoint: Viewpoint, on_free_floor: Mask
    ) -> Tracks:
        """Update by one frame and return the confirmed tracks, by id.

        Args:
            time: time of the frame [s].
            detections: detections in W.
            viewpoint: camera in W, with the range and the part of the image in which detection is
                certain.
            on_free_floor: whether each detection is on floor seen empty before (m,): a new obstacle
                there has moved.
        """
        p, rows = self._record, detections.rows
        dt = 0.0 if self._time is None else time - self._time
        self._time = time
        labels = self._labels_of(detections)
        assigned = np.zeros(len(rows), np.bool_)
        if len(self._objects):
            self._predict(dt)
            birth = np.where(on_free_floor, self._intruder_cost, self._birth_cost)
            pairs = assign(
                association_costs(self._objects, self._clouds, rows, labels, birth, time, p)
            )
            correct_all(self._objects, rows, *pairs, time, p)
            assigned[pairs[1]] = True
        if not assigned.all():
            born = births(self._objects, rows, labels, assigned, on_free_floor, time, p)
            self._add(born)
        self._handle_misses(time, dt, detections, viewpoint)
        self._keep(distinct(self._objects, time, p))
        return Tracks(*published(self._objects, self._clouds, time, p), tuple(self._labels))

    def _labels_of(self, detections: Detections) -> Indices:
        """Return the colour classes of detections as indices in the labels of the tracker (m,)."""
        for label in detections.labels:
            if label not in self._labels:
                self._labels.append(label)
        return np.array([self._labels.index(label) for label in detections.labels], np.int64)

    def _predict(self, dt: float) -> None:
        count, rng = self._parameters.particles, self._rng
        predict_all(self._objects, dt, self._record)
        for i in np.flatnonzero(self._objects["lost"]).tolist():
            noise, draws = rng.standard_normal(count), rng.random(count)
            particles.advance(self._clouds[i], noise, draws, dt, self._record)

    def _add(self, born: Rows) -> None:
        """Add new objects."""
        count = len(born)
        born["id"] = np.arange(self._next_id, self._next_id + count)
        self._next_id += count
        self._objects = np.concatenate([self._objects, born])
        clouds = np.zeros((count, *self._clouds.shape[1:]))
        self._clouds = np.concatenate([self._clouds, clouds])

    def _keep(self, mask: Mask) -> None:
        """Delete all objects but those of a mask (n,)."""
        if not mask.all():
            self._objects, self._clouds = self._objects[mask], self._clouds[mask]

    def _handle_misses(
        self, time: float, dt: float, detections: Detections, viewpoint: Viewpoint
    ) -> None:
        """Count missed detections, spawn and weigh particles, delete tracks."""
        if (self._objects["last_time"] == time).all():
            return
        p, clouds, rng = self._parameters, self._clouds, self._rng
        fates = misses(self._objects, clouds, detections.rows, *viewpoint, time, dt, self._record)
        for i in np.flatnonzero(fates >= SPAWNS).tolist():
            if fates[i] == REFUTED:
                clouds[i] = particles.resample(clouds[i], p, rng)
            else:
                o = self._objects[i]
                parts = o["weights"], o["states"], o["covariances"]
                clouds[i] = particles.spawn(*parts, p.particles, rng)
        self._keep(fates != DELETED)
        self._redistribute(time, detections, viewpoint)

    def _redistribute(self, time: float, detections: Detections, viewpoint: Viewpoint) -> None:
        """Redistribute refuted particles over the reachable area out of view."""
        p, objects = self._parameters, self._objects
        refuted = objects["lost"] & (objects["existence"] < p.min_existence)
        if not refuted.any():
            return
        # An undecided object neither moved nor is at its position: a likely false detection.
        kept = ~(refuted & (objects["motion"] == UNKNOWN))
        for i in np.flatnonzero(refuted & kept).tolist():
            o = objects[i]
            velocity = imm.mean(o["weights"], o["states"])[2:4]
            radius = search_radius(o, time, self._record[0])
            cloud = particles.redistribute(o["last_seen"], radius, velocity, p, self._rng)
            hidden = np.flatnonzero(~self._in_clear_view(cloud, detections, viewpoint))
            hidden = hidden[: p.particles]
            o["existence"] = 1.0
            if len(hidden) < p.particles:
                kept[i] = False
            else:
                self._clouds[i, :WEIGHT] = cloud[:WEIGHT, hidden]
                self._clouds[i, WEIGHT] = 1.0 / p.particles
        self._keep(kept)

    def _in_clear_view(self, cloud: Array, detections: Detections, viewpoint: Viewpoint) -> Mask:
        """Return whether each particle of a cloud (6, m) is in clear view (m,)."""
        eye, points = viewpoint.eye, np.ascontiguousarray(cloud[X : Y + 1].T)
        discs = occluders(self._objects, detections.rows, eye, self._record)
        return clearly_visible(points, eye[0], viewpoint.shadow, discs)


@compiled
def predict_all(objects: Rows, dt: float, parameters: Rows) -> None:
    """Predict the filters of all objects by `dt` [s], in place."""
    p = parameters[0]
    imm.predict(objects["weights"], objects["states"], objects["covariances"], dt, p)


@compiled
def correct_all(
    objects: Rows, detections: Rows, rows: Indices, columns: Indices, time: float, parameters: Rows
) -> None:
    """Update the objects `rows` (k,) by the detections `columns` (k,), in place."""
    p = parameters[0]
    for k in range(len(rows)):
        correct(objects[rows[k]], detections[columns[k]], time, p)


@compiled
def is_part_of(o: np.record, d: np.record, label: int, time: float, p: np.record) -> bool:
    """Return whether a detection lies in an object of its colour, detected in its frame.

    Args:
        o: record of type `ObjectRecord`.
        d: record of type `DetectionRecord`.
        label: colour class of the detection.
        time: time of the frame [s].
        p: parameters of tracking.
    """
    if o.label != label or o.last_time != time:
        return False
    x, y = position_of(o)
    dx, dy = x - d.position[0], y - d.position[1]
    reach = p.merge_fraction * d.radius + p.merge_fraction * o.radius
    return bool(dx * dx + dy * dy < reach * reach)


@compiled
def births(
    objects: Rows,
    detections: Rows,
    labels: Indices,
    assigned: Mask,
    on_free_floor: Mask,
    time: float,
    parameters: Rows,
) -> Rows:
    """Return tentative tracks, without numbers, at the unassigned detections within range.

    A detection that lies in an object of its colour and frame is a part of that object.

    Args:
        objects: records of type `ObjectRecord` (n,).
        detections: records of type `DetectionRecord` (m,).
        labels: colour classes of the detections (m,).
        assigned: detections of known objects (m,).
        on_free_floor: detections on floor seen empty before (m,).
        time: time of the frame [s].
        parameters: record of the parameters of tracking (1,).
    """
    p = parameters[0]
    born, count = np.zeros(len(detections), ObjectRecord), 0
    for j in range(len(detections)):
        d = detections[j]
        excluded = assigned[j] or d.distance > p.birth_range
        for i in range(len(objects)):
            excluded = excluded or is_part_of(objects[i], d, labels[j], time, p)
        for i in range(count):
            excluded = excluded or is_part_of(born[i], d, labels[j], time, p)
        if not excluded:
            born[count].label = labels[j]
            begin(born[count], d, on_free_floor[j], time, p)
            count += 1
    return born[:count]


@compiled
def occluders(objects: Rows, detections: Rows, eyes: Rows, parameters: Rows) -> Array:
    """Return detections and static objects as discs relative to the camera, see `relative_discs`.

    Args:
        objects: records of type `ObjectRecord` (n,).
        detections: records of type `DetectionRecord` (m,).
        eyes: camera, record of type `Eye` (1,).
        parameters: record of the parameters of tracking (1,).
    """
    m, size = len(detections), len(detections) + len(objects)
    centres, radii = np.empty((size, 2)), np.empty(size)
    for j in range(m):
        d = detections[j]
        centres[j, 0], centres[j, 1], radii[j] = d.position[0], d.position[1], d.radius
    for i in range(len(objects)):
        o = objects[i]
        if o.motion == STATIC:
            centres[m, 0], centres[m, 1] = position_of(o)
            radii[m] = o.radius
            m += 1
    return relative_discs(eyes[0], centres[:m], radii[:m], parameters[0].occlusion_margin)


@compiled
def misses(
    objects: Rows,
    clouds: Array,
    detections: Rows,
    eyes: Rows,
    shadow: Array,
    time: float,
    dt: float,
    parameters: Rows,
) -> Indices:
    """Handle a frame without the detection of some objects, in place.

    Args:
        objects: records of type `ObjectRecord` (n,).
        clouds: their particles (n, 6, k).
        detections: records of type `DetectionRecord` (m,).
        eyes: camera, record of type `Eye` (1,).
        shadow: see `in_view`.
        time: time of the frame [s].
        dt: time since the last frame [s].
        parameters: record of the parameters of tracking (1,).

    Returns:
        Fate of each object (n,): KEPT; DELETED; SPAWNS, it is lost now and particles are to be
        drawn; or REFUTED, its particles were not seen.
    """
    p, eye = parameters[0], eyes[0]
    discs = occluders(objects, detections, eyes, parameters)
    fates = np.full(len(objects), KEPT)
    survival = (1.0 - p.detection_probability) ** (dt / p.detection_time)
    for i in range(len(objects)):
        o = objects[i]
        if o.last_time == time:
            continue
        age = time - o.last_time
        if o.hits < p.birth_hits:
            fates[i] = KEPT if age <= p.birth_time else DELETED
        elif o.motion == STATIC:
            x, y = position_of(o)
            dx, dy = x - eye.position[0], y - eye.position[1]
            expected = in_view(dx, dy, eye, shadow) and not occluded(dx, dy, discs)
            o.unseen_time = o.unseen_time + dt if expected else 0.0
            if o.unseen_time >= p.miss_time:
                o.unseen_time = 0.0
                o.misses += 1
            fates[i] = KEPT if o.misses < p.max_misses else DELETED
        elif age > (p.forget_time if o.hits >= p.min_moving_hits else p.tentative_time):
            fates[i] = DELETED
        elif o.lost:
            points = np.ascontiguousarray(clouds[i, :VX].T)
            visible = clearly_visible(points, eye, shadow, discs)
            o.existence *= particles.refute(clouds[i], visible, survival)
            fates[i] = REFUTED
        elif age > p.lost_time:
            o.lost = True
            fates[i] = SPAWNS
    return fates
