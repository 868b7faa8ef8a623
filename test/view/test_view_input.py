#!/usr/bin/python3
"""The page of velo view in a real browser: undo of each input, keys wherever the focus is, picking by keyboard, exposures, digits,
the notice and what the tool Focus says. Skipped without chromium."""
import os
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, cannot_view  # noqa: E402
from live import View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SCENE = '''LookAt 0 1 5 0 0 0 0 1 0
Camera "perspective" "float fov" 40
Sampler "halton" "integer pixelsamples" 4
Film "rgb" "integer xresolution" 320 "integer yresolution" 240
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.9]
Material "diffuse" "rgb reflectance" [0.7 0.2 0.1]
Shape "sphere" "float radius" 0.8
Shape "bilinearmesh" "point3 P" [-9 -0.8 -9 9 -0.8 -9 -9 -0.8 9 9 -0.8 9]
'''
KEYS = {"Enter": 13, "Escape": 27, " ": 32, "Home": 36, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}


def press(b, key, shift=False):
    """A key, as a keyboard sends it."""
    number = KEYS.get(key, ord(key[0].upper()))
    text = {"text": "\r"} if key == "Enter" else {"text": key} if len(key) == 1 else {}
    b.call("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", key=key, code=key, windowsVirtualKeyCode=number,
           modifiers=8 if shift else 0, **text)
    b.call("Input.dispatchKeyEvent", type="keyUp", key=key, code=key, windowsVirtualKeyCode=number, modifiers=8 if shift else 0)


def eye(b):
    return b.run("velo.state.camera.eye")


def settled(b):
    """The camera when all edits are answered."""
    b.wait("!velo.queued && !velo.sent.length")
    return eye(b)


def near(p, q):
    return max(abs(v - w) for v, w in zip(p, q)) < 1e-9


def middle(b):
    x, y, w, h = b.run("(() => { const r = document.getElementById('screen').getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()")
    return x + w / 2, y + h / 2


def home(b):
    b.run("velo.reset()")
    b.wait("Math.abs(velo.state.camera.eye[2] - 5) < 1e-9 && Math.abs(velo.state.camera.eye[0]) < 1e-9 && velo.state.camera.lens_radius === 0")


def twice(b, event):
    """Two events without a pause: from a busy browser's protocol they would come as two inputs."""
    b.run(f"document.getElementById('stage').focus(); for (let i = 0; i < 2; i++) document.getElementById('stage').dispatchEvent({event})")


def test_undo(b):
    """One input is one step of undo: a drag, the turns of the wheel after it, another drag, keys."""
    x, y = middle(b)
    steps = [settled(b)]
    wheel = lambda: b.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=120)
    for act in (lambda: b.drag(x, y, x + 60, y), lambda: twice(b, f"new WheelEvent('wheel', {{clientX: {x}, clientY: {y}, deltaY: 120, bubbles: true}})"),
                lambda: b.drag(x, y, x + 40, y, steps=30), lambda: twice(b, "new KeyboardEvent('keydown', {key: 'w', bubbles: true})")):
        act()
        steps.append(settled(b))
        check(f"moves_{len(steps) - 1}", not near(steps[-1], steps[-2]), steps)
    wheel()
    b.drag(x, y, x + 40, y + 5, steps=40)  # it takes longer than the wheel's pause
    last = settled(b)
    for wanted in [None] + steps[-2::-1]:
        b.click_on("#undo")
        b.wait(f"!velo.sent.length && velo.state.change === velo.change")
        if wanted is None:
            check("undo_of_a_drag_after_the_wheel", not near(eye(b), steps[-1]) and not near(eye(b), last), eye(b), steps)
            b.click_on("#undo")
            b.wait(f"velo.state.change === velo.change")
            check("undo_of_the_wheel", near(eye(b), steps[-1]), eye(b), steps)
        else:
            check(f"undo_to_{steps.index(wanted)}", near(eye(b), wanted), eye(b), wanted)


def test_undo_ends_a_drag(b):
    """Undo while the button is down: the rest of the drag does nothing, the next one goes on from there."""
    home(b)
    x, y = middle(b)
    before = settled(b)
    b.run("document.getElementById('stage').focus()")
    b.mouse("mousePressed", x, y)
    for i in range(1, 6):
        b.mouse("mouseMoved", x + 10 * i, y)
    check("drag_moves", not near(settled(b), before), eye(b))
    press(b, "z")
    b.wait("velo.state.change === velo.change")
    check("undo_in_a_drag", near(settled(b), before), eye(b), before)
    for i in range(6, 12):
        b.mouse("mouseMoved", x + 10 * i, y)
    b.mouse("mouseReleased", x + 110, y, buttons=0)
    b.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    check("undo_stays", near(settled(b), before), eye(b), before)
    b.drag(x, y, x + 60, y)
    check("next_drag_moves", not near(settled(b), before), eye(b))


def test_keys(b):
    """A button, a summary or a slider with the focus leaves other keys to the camera."""
    for name, selector in (("button", "#outside-toggle"), ("tool", "#tools [data-tool=orbit]"), ("summary", "#save summary"),
                           ("slider", "#exposure")):
        home(b)
        b.run(f"document.querySelector({selector!r}).focus()")
        press(b, "w")
        b.wait("Math.abs(velo.state.camera.eye[2] - 5) > 1e-6", 10)
        check(f"keys_beside_a_{name}", True)
    home(b)
    b.click_on("#tools [data-tool=orbit]")
    press(b, "ArrowRight")
    b.wait("Math.abs(velo.state.camera.eye[0]) > 1e-6", 10)
    check("arrows_after_a_tool", True)
    home(b)
    b.run("document.getElementById('spp').focus()")
    press(b, "w")
    press(b, "1")
    check("a_field_keeps_its_keys", near(settled(b), [0, 1, 5]) and "1" in b.run("document.getElementById('spp').value"), eye(b))
    b.run("(() => { const s = document.getElementById('spp'); s.value = 4; s.onchange(); s.blur(); })()")


def test_pick(b):
    """A pixel is picked, the lens focused and a rectangle set without a pointer."""
    home(b)
    b.wait("velo.screen.frame.scale === 1")
    b.run("document.getElementById('stage').focus()")
    press(b, "Enter")
    check("cross", b.run("document.querySelectorAll('#overlay .cross').length") == 8)
    for key, shift in (("ArrowRight", True), ("ArrowRight", False), ("ArrowUp", True), ("ArrowDown", False)):
        press(b, key, shift)
    check("cross_moves", b.run("document.getElementById('hover').textContent").startswith("171, 111 "), b.run("document.getElementById('hover').textContent"))
    check("cross_is_read", b.run("document.getElementById('hover').ariaLive") == "polite")
    press(b, "Enter")
    b.wait("document.querySelector('#pixel dl').textContent.includes('171, 111')")
    check("picked", "sphere" in b.run("document.querySelector('#pixel dl').textContent"))
    check("arrows_are_not_the_camera's", near(settled(b), [0, 1, 5]))
    press(b, "Escape")
    check("cross_ends", b.run("document.querySelectorAll('#overlay .cross').length") == 0)
    press(b, "ArrowRight")
    b.wait("Math.abs(velo.state.camera.eye[0]) > 1e-6", 10)
    home(b)
    press(b, "6")
    press(b, "Enter")
    press(b, "Enter")
    for key in ("ArrowRight", "ArrowRight", "ArrowDown"):
        press(b, key, True)
    press(b, "Enter")
    b.wait("velo.cropped && velo.state.crop.join() === '160,120,181,131'", 20)
    check("crop_by_keyboard", True)
    press(b, "Escape")
    b.wait("!velo.cropped")
    press(b, "1")


def test_focus(b):
    """The tool Focus says what it did, also where that changes nothing that is seen."""
    home(b)
    x, y = middle(b)
    b.click_on("#tools [data-tool=focus]")
    b.click(x, y)
    text = b.wait("!document.getElementById('notice').hidden && document.getElementById('notice').textContent", 20)
    check("focus_of_a_pinhole", "Focus at 4." in text and "no opening" in text, text)
    b.run("velo.edit({lens_radius: 0.1})")
    b.wait("velo.state.camera.lens_radius === 0.1")
    b.run("velo.notice('')")
    b.click(x, y)
    text = b.wait("!document.getElementById('notice').hidden && document.getElementById('notice').textContent", 20)
    check("focus_of_a_lens", "Focus at 4." in text and "no opening" not in text, text)
    b.run("velo.notice('')")
    home(b)
    b.run("velo.edit({lookat: [0, 9, 5.5]})")
    settled(b)
    b.click(x, y)
    text = b.wait("!document.getElementById('notice').hidden && document.getElementById('notice').textContent", 20)
    check("focus_on_nothing", "Focus at" not in text, text)
    b.run("velo.notice('')")
    b.click_on("#tools [data-tool=orbit]")
    home(b)


def test_notice(b):
    """The notice is above the view from outside, and a button closes it."""
    b.click_on("#outside-toggle")
    b.run("velo.notice('a file has an error, and here is a long sentence that says which one it is and where it stands ' + 'x'.repeat(200))")
    over = ("(() => { const n = document.getElementById('notice').getBoundingClientRect(), o = document.getElementById('outside').getBoundingClientRect();"
            "const x = (Math.max(n.left, o.left) + Math.min(n.right, o.right)) / 2, y = (Math.max(n.top, o.top) + Math.min(n.bottom, o.bottom)) / 2;"
            "return [Math.min(n.right, o.right) - Math.max(n.left, o.left), document.elementFromPoint(x, y).closest('#notice, #outside').id]; })()")
    width, top = b.run(over)
    check("notice_is_above_the_pane", width > 20 and top == "notice", width, top)
    b.click_on("#notice-close")
    check("notice_closes", b.run("document.getElementById('notice').hidden"))
    b.click_on("#outside-toggle")


def test_digits(b):
    """Numbers fit their fields, and an edit of one keeps all digits of the others."""
    b.run("velo.edit({eye: [-0.12345678901, 1.23456789012, -12345.6789012]})")
    settled(b)
    cut = "[...document.querySelectorAll('#camera input[type=text]')].filter(i => i.clientWidth && i.scrollWidth > i.clientWidth + 1).map(i => i.value)"
    check("digits_fit", b.run(cut) == [], b.run(cut))
    shown = b.run("document.getElementById('field-eye').value")
    check("many_digits", shown.startswith("-0.1234"), shown)
    b.run("document.getElementById('field-eye').focus()")
    check("all_digits_with_the_focus", b.run("document.getElementById('field-eye').value") == "-0.123456789", b.run("document.getElementById('field-eye').value"))
    b.run("document.getElementById('field-eye').blur()")
    check("digits_fit_again", b.run("document.getElementById('field-eye').value") == shown)
    b.run("(() => { const e = document.querySelectorAll('#camera .several input')[1]; e.focus(); e.value = '2'; e.dispatchEvent(new Event('change', {bubbles: true})); e.blur(); })()")
    b.wait("velo.state.camera.eye[1] === 2")
    check("others_keep_their_digits", eye(b) == [-0.12345678901, 2, -12345.6789012], eye(b))
    home(b)


def test_exposure(folder):
    """An exposure that the slider cannot show is the page's all the same."""
    for given, wanted in (("0.33", 0.33), ("-9.5", -9.5)):
        view = View(VELO, os.path.join(folder, "shown.pbrt"), "--exposure", given, cwd=folder)
        b = Browser()
        try:
            b.open(view.address)
            b.wait("velo.frames > 0 && velo.state && velo.steers")
            here = b.run("[velo.display.ev, velo.screen.display.exposure, document.querySelector('[aria-label=\"exposure in stops\"]').value]")
            check(f"exposure_{given}", here == [wanted, wanted, given], here)
            b.type_into('[aria-label="exposure in stops"]', "-7.123")
            check("exposure_typed", b.run("velo.display.ev") == -7.123)
            b.run("velo.expose(0.25)")
            check("exposure_key", b.run("velo.display.ev") == -6.873)
        finally:
            b.end()
            view.end()


def main():
    reason = cannot_view(VELO)
    if reason:
        print(f"skip view_input: {reason}")
        return
    folder = tempfile.mkdtemp(prefix="velo-view-")
    with open(os.path.join(folder, "shown.pbrt"), "w") as file:
        file.write(SCENE)
    view = View(VELO, os.path.join(folder, "shown.pbrt"), cwd=folder)
    b = Browser()
    try:
        b.open(view.address)
        b.wait("velo.frames > 0 && velo.state && velo.steers")
        for test in (test_undo, test_undo_ends_a_drag, test_keys, test_pick, test_focus, test_notice, test_digits):
            test(b)
        check("no_errors", not b.problems(), b.problems())
    finally:
        b.end()
        view.end()
    test_exposure(folder)
    shutil.rmtree(folder)


main()
results.end()
