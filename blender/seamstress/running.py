# SPDX-License-Identifier: GPL-3.0-or-later
"""How operators run: jobs one after the other, while Blender goes on; Esc ends them and changes nothing."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy
from bpy.app.translations import pgettext_iface as iface
from bpy.app.translations import pgettext_rpt as rpt

from .jobs import PAUSE, Failure, Job
from .reading import Unfit

#: Time between two looks at the jobs, s.
TICK = 0.1


@dataclass(frozen=True)
class Task:
    """A job for an object, and what to do with its result."""

    label: str
    function: str
    arguments: dict[str, Any]
    #: Changes Blender's data by the result, and says what was done.
    finish: Callable[[dict[str, Any]], str]


@dataclass
class Queue:
    """Tasks, of which one runs at a time."""

    tasks: list[Task]
    #: Those that have ended, each with its result or why there is none.
    outcomes: list[tuple[Task, "dict[str, Any] | Failure"]] = field(default_factory=list)
    _job: "Job | None" = None

    def step(self) -> bool:
        """Looks after the job that runs, and starts the next. Whether there is something left to wait for."""
        if self._job is not None and not self._job.is_running:
            task = self.tasks[len(self.outcomes)]
            try:
                self.outcomes.append((task, self._job.result()))
            except Failure as failure:
                self.outcomes.append((task, failure))
            self._job = None
        while self._job is None and len(self.outcomes) < len(self.tasks):
            task = self.tasks[len(self.outcomes)]
            try:
                self._job = Job(task.function, **task.arguments)
            except Failure as failure:
                self.outcomes.append((task, failure))
        return self._job is not None

    def cancel(self) -> None:
        """Ends the job that runs, and forgets the others."""
        if self._job is not None:
            self._job.cancel()
        self._job = None
        self.outcomes.clear()
        self.tasks = []

    @property
    def progress(self) -> tuple[str, float]:
        """What is done now, for people, and the share of all that is done."""
        if self._job is None:
            return "", 1.0
        stage, fraction = self._job.progress
        label = self.tasks[len(self.outcomes)].label
        return f"{label}: {iface(stage)}", (len(self.outcomes) + fraction) / len(self.tasks)


#: What runs in the window: its progress is shown in the panel, which can also ask it to stop.
current: "Queue | None" = None


class Running:
    """An operator whose work is done by jobs. `execute` waits for them, `invoke` lets Blender go on."""

    @classmethod
    def objects(cls, context: bpy.types.Context) -> list[bpy.types.Object]:
        """The meshes to work on, also those in collections that are instanced."""
        chosen = selected(context)
        meshes = [object for object in [*chosen, *instanced(chosen)] if object.type == "MESH"]
        return list(dict.fromkeys(meshes))

    def result_of(self, object: bpy.types.Object) -> Any:
        """What objects have in common that share a result."""
        return object.data

    def task(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> Task:
        """The task of objects that share a result. Raises ``Unfit`` if there is nothing to work on."""
        raise NotImplementedError

    def end(self, context: bpy.types.Context) -> None:
        """Called when all tasks are done with, whatever became of them."""
        if self._was_editing and context.mode == "OBJECT" and context.object is not None:
            bpy.ops.object.mode_set(mode="EDIT")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if current is not None:
            cls.poll_message_set(rpt("Seamstress is at work; Esc stops it"))
            return False
        return bool(cls.objects(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        queue = self._queue(context)
        context.window_manager.progress_begin(0.0, 1.0)
        try:
            while queue.step():
                context.window_manager.progress_update(queue.progress[1])
                time.sleep(PAUSE)
        except BaseException:
            queue.cancel()
            raise
        finally:
            context.window_manager.progress_end()
        return self._finish(context, queue)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self.execute(context) if bpy.app.background else self.begin(context)

    def begin(self, context: bpy.types.Context) -> set[str]:
        """Starts the work, and lets Blender go on."""
        global current
        self._running = current = self._queue(context)
        self._timer = context.window_manager.event_timer_add(TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if current is not self._running or (event.type == "ESC" and event.value == "PRESS"):
            self.cancel(context)
            self.report({"WARNING"}, rpt("Cancelled; nothing was changed"))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        queue = self._running
        if queue.step():
            text, fraction = queue.progress
            context.workspace.status_text_set(f"{text} {fraction:.0%}   {iface('Esc: Cancel')}")
            redraw(context)
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._finish(context, queue)

    def cancel(self, context: bpy.types.Context) -> None:
        """Ends the work; Blender calls this also when it closes the file."""
        self._running.cancel()
        self._leave(context)
        self.end(context)

    def _leave(self, context: bpy.types.Context) -> None:
        global current
        if current is self._running:
            current = None
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        redraw(context)

    def _queue(self, context: bpy.types.Context) -> Queue:
        self._failed = []
        groups: dict[Any, list[bpy.types.Object]] = {}
        for object in self.objects(context):
            groups.setdefault(self.result_of(object), []).append(object)
        self._was_editing = context.mode.startswith("EDIT")
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        tasks = []
        for objects in groups.values():
            try:
                tasks.append(self.task(context, objects))
            except Unfit as reason:
                self._failed.append(str(reason))
        return Queue(tasks)

    def _finish(self, context: bpy.types.Context, queue: Queue) -> set[str]:
        done = []
        for task, outcome in queue.outcomes:
            try:
                if isinstance(outcome, Failure):
                    raise outcome
                done.append(f"{task.label}: {task.finish(outcome)}")
            except Unfit as reason:
                self._failed.append(f"{task.label}: {reason}")
            except Failure as reason:
                more = rpt("Check selects what is wrong") if reason.code == "not-a-surface" else ""
                self._failed.append(f"{task.label}: {reason.translated(rpt)}\n{more}".strip())
        self.end(context)
        for text in done:
            self.report({"INFO"}, text)
        for text in self._failed:
            self.report({"WARNING" if done else "ERROR"}, text)
        return {"FINISHED"} if done else {"CANCELLED"}


class SEAMSTRESS_OT_stop(bpy.types.Operator):
    """Stop the work of Seamstress that runs; nothing is changed"""

    bl_idname = "seamstress.stop"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return current is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        global current
        current.cancel()
        # The operator that runs sees this at its next look.
        current = None
        return {"FINISHED"}


def selected(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The objects that are edited or selected, of any kind; else the active one."""
    if context.mode.startswith("EDIT"):
        return list(context.objects_in_mode)
    return context.selected_objects or [object for object in [context.active_object] if object is not None]


def instanced(objects: list[bpy.types.Object]) -> list[bpy.types.Object]:
    """The objects in the collections that objects are instances of."""
    collections = [object.instance_collection for object in objects if object.instance_type == "COLLECTION"]
    return [object for collection in filter(None, collections) for object in collection.all_objects]


def redraw(context: bpy.types.Context) -> None:
    """Shows progress in the panels."""
    for area in context.screen.areas if context.screen else []:
        if area.type == "VIEW_3D":
            area.tag_redraw()
