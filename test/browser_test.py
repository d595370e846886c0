# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The page of examples/browser in headless Chromium, beside the native program:
#   browser_test.py PAGE SPECTRAL_SIMPLIFY MAKE_DEMO_SHAPE FOLDER
# Results and screenshots stay in FOLDER. Its last line counts what passed and failed.

import json
import pathlib
import subprocess
import sys
import time
import traceback

import numpy
import scipy.io
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

page, native, demo = (pathlib.Path(path).resolve() for path in sys.argv[1:4])
folder = pathlib.Path(sys.argv[4]).resolve()
folder.mkdir(parents=True, exist_ok=True)
for old in folder.iterdir():
    old.unlink()


def browser(width, height):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in (
        "--headless=new",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--hide-scrollbars",
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.execute_cdp_cmd(
        "Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)}
    )
    resize(driver, width, height)
    driver.set_script_timeout(60)
    driver.get(page.as_uri())
    return driver


def resize(driver, width, height):
    driver.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 700},
    )


def text(driver, name):
    return driver.find_element(By.ID, name).text


def wait_until(condition, what, seconds=300):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"waited {seconds} s in vain: {what}"
        time.sleep(0.1)


def wait_for(driver, status, seconds=300):
    def there():
        if text(driver, "status").startswith(status):
            return True
        wrong = driver.find_elements(By.CSS_SELECTOR, "#sentences.wrong li")
        assert not wrong, f"waited for '{status}', but: {wrong[0].text}"
        return False

    wait_until(there, status, seconds)


def fill(driver, vertices, eigenvectors, preset, form):
    for name, value in ("vertices", vertices), ("eigenvectors", eigenvectors):
        field = driver.find_element(By.ID, name)
        field.clear()
        field.send_keys(str(value))
    Select(driver.find_element(By.ID, "preset")).select_by_value(preset)
    Select(driver.find_element(By.ID, "format")).select_by_visible_text(form)


def press(driver, name):
    driver.find_element(By.ID, name).click()


def drop(driver, path):
    """As a user drops a file: chosen by a field of the test's own, dropped by an event."""
    field = driver.execute_script(
        "const field = document.createElement('input'); field.type = 'file';"
        "document.body.append(field); return field;"
    )
    field.send_keys(str(path))
    driver.execute_script(
        "const data = new DataTransfer(); data.items.add(arguments[0].files[0]);"
        "document.getElementById('drop').dispatchEvent("
        "new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));"
        "arguments[0].remove();",
        field,
    )


def downloaded(driver, name):
    path = folder / name
    driver.find_element(By.CSS_SELECTOR, f"#downloads a[download='{name}']").click()
    wait_until(path.exists, f"download of {name}", 30)
    return path


def off(path):
    words = path.read_text().split()
    assert words[0] == "OFF", path
    n = int(words[1])
    numbers = words[4:]
    vertices = numpy.array(numbers[: 3 * n], float).reshape(n, 3)
    faces = numpy.array(numbers[3 * n :], int).reshape(-1, 4)[:, 1:]
    return vertices, faces


def shape(vertices):
    path = folder / f"shape{vertices}.off"
    subprocess.run(
        [demo, path, "--vertices", str(vertices)], check=True, stdout=subprocess.DEVNULL
    )
    return path


def diagonal(vertices):
    return numpy.linalg.norm(vertices.max(axis=0) - vertices.min(axis=0))


def beside_native(driver, vertices, preset, exact):
    """Drops a shape, and compares what the page makes of it with what the native program does."""
    path = shape(vertices)
    drop(driver, path)
    wait_for(driver, "Ready.")
    shown = text(driver, "shape")
    n = int(path.read_text().split()[1])
    assert shown == f"{path.name}, {n:,} vertices", shown
    fill(driver, 400, 100, preset, ".off")
    press(driver, "simplify")
    wait_for(driver, "Done")
    files = {
        end: downloaded(driver, f"{path.stem}-coarse{end}")
        for end in (".off", "-P.mtx", ".json", ".html")
    }
    kept = {end: path.rename(folder / f"{preset}{end}") for end, path in files.items()}
    names = {end: folder / f"native-{preset}{end}" for end in kept}
    command = text(driver, "command")
    options = ["--vertices", "400", "--eigenvectors", "100", "--preset", preset]
    assert command.split()[3:9] == options, command
    assert f"<code>{command}" in kept[".html"].read_text()
    outputs = ["--restriction", names["-P.mtx"], "--json", names[".json"]]
    subprocess.run(
        [native, path, names[".off"], *options, *outputs, "--threads", "1", "--quiet"], check=True
    )
    (V, F), (W, G) = off(kept[".off"]), off(names[".off"])
    P, Q = scipy.io.mmread(kept["-P.mtx"]), scipy.io.mmread(names["-P.mtx"])
    assert V.shape == (400, 3) and F.shape == G.shape and P.shape == Q.shape == (400, n)
    if exact:
        apart = numpy.abs(V - W).max() / diagonal(W)
        print(f"  {preset}: vertices differ by {apart:.1e} of the diagonal")
        assert (F == G).all()
        assert apart < 1e-6, apart
        assert abs(P - Q).max() < 1e-6
    here, there = (json.loads(files[".json"].read_text()) for files in (kept, names))
    for figure in "norm_L", "norm_D", "eigenvalue_error_mean", "relative_error":
        ratio = here[figure] / there[figure]
        assert abs(ratio - 1) < (1e-5 if exact else 0.1), (figure, ratio)


def simplifies_what_is_dropped(driver):
    """The vertices, the faces, P and the norms are those of the native program."""
    beside_native(driver, 10000, "fast", exact=True)


def has_all_presets(driver):
    """With these shapes rounding, which differs by fused operations, decides on some collapses or
    steps of relocation: the results differ as those of two equally good runs."""
    beside_native(driver, 4000, "best", exact=False)
    beside_native(driver, 4000, "paper", exact=False)


def shows_the_report(driver):
    """The viewer of the report turns both meshes, by all colours that there are."""
    press(driver, "demo")
    wait_for(driver, "Ready.")
    fill(driver, 500, 100, "fast", ".ply")
    press(driver, "simplify")
    wait_for(driver, "Done")
    for width, height in ((1280, 1000), (390, 844)):
        resize(driver, width, height)
        time.sleep(2)
        driver.execute_script("scrollTo(0, 0)")
        driver.save_screenshot(str(folder / f"page-{width}.png"))
        wide = driver.execute_script("return document.documentElement.scrollWidth")
        assert wide <= width, f"the page is {wide} wide on a screen of {width}"
        driver.execute_script("document.getElementById('report').scrollIntoView()")
        time.sleep(1)
        driver.save_screenshot(str(folder / f"report-{width}.png"))
    resize(driver, 1280, 1000)
    frame = driver.find_element(By.ID, "report")
    driver.switch_to.frame(frame)
    assert "The first 100 eigenvalues are off by" in driver.page_source
    canvases = driver.find_elements(By.CSS_SELECTOR, ".shapes canvas")
    assert len(canvases) == 2, "no views to turn"
    colours = Select(driver.find_element(By.ID, "shape-function"))
    names = [option.text for option in colours.options]
    for kind in "Eigenfunction", "Heat kernel signature", "Distance between the surfaces":
        assert any(name.startswith(kind) for name in names), names
    pictures = set()
    for name in names:
        colours.select_by_visible_text(name)
        driver.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 50))")
        pictures.add(tuple(driver.execute_script(
            "return [...document.querySelectorAll('.shapes canvas')].map(c => c.toDataURL())"
        )))  # fmt: skip
    assert len(pictures) == len(names), "two colours look alike"
    webdriver.ActionChains(driver).drag_and_drop_by_offset(canvases[0], 80, 20).perform()
    driver.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 50))")
    turned = driver.execute_script(
        "return [...document.querySelectorAll('.shapes canvas')].map(c => c.toDataURL())"
    )
    assert all(turned[i] not in {p[i] for p in pictures} for i in (0, 1)), "one does not turn"
    driver.switch_to.default_content()


def says_what_is_wrong(driver):
    """Sentences of the program, and the page goes on afterwards."""

    def sentence():
        wait_until(lambda: driver.find_elements(By.CSS_SELECTOR, "#sentences.wrong li"), "refusal")
        return text(driver, "sentences")

    broken = folder / "broken.off"
    broken.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 zero\n3 0 1 2\n")
    drop(driver, broken)
    assert "broken.off" in sentence() and "zero" in sentence(), sentence()
    assert not driver.find_element(By.ID, "simplify").is_enabled()
    press(driver, "demo")
    wait_for(driver, "Ready.")
    fill(driver, 50, 100, "best", ".ply")
    press(driver, "simplify")
    assert "has only 50 modes" in sentence(), sentence()
    fill(driver, 20000, 100, "best", ".ply")
    press(driver, "simplify")
    wait_until(lambda: "--vertices is 20000, but" in text(driver, "sentences"), "refusal")


def refuses_what_is_too_large(driver):
    """By the estimate, before it starts: one matrix of the eigenvectors is beyond 4 GB."""
    drop(driver, shape(24000))
    wait_for(driver, "Ready.")
    fill(driver, 23000, 23000, "best", ".ply")
    begin = time.monotonic()
    press(driver, "simplify")
    wait_until(lambda: "of memory, but this machine has" in text(driver, "sentences"), "refusal")
    assert time.monotonic() - begin < 10
    print("  " + text(driver, "sentences").replace("\n", "\n  "))


def is_cancelled(driver):
    press(driver, "demo")
    wait_for(driver, "Ready.")
    fill(driver, 300, 100, "paper", ".ply")
    press(driver, "simplify")
    wait_until(lambda: text(driver, "status").startswith("collapses"), "collapses", 120)
    value = driver.execute_script("return document.getElementById('progress').value")
    assert 0 <= value < 1, value
    press(driver, "cancel")
    wait_for(driver, "Ready.")
    assert not driver.find_element(By.ID, "result").is_displayed()
    fill(driver, 300, 60, "fast", ".ply")
    press(driver, "simplify")
    wait_for(driver, "Done")


def main():
    passed = failed = 0
    driver = browser(1280, 1000)
    wait_for(driver, "Ready.")
    for test in (
        simplifies_what_is_dropped,
        has_all_presets,
        shows_the_report,
        says_what_is_wrong,
        refuses_what_is_too_large,
        is_cancelled,
    ):
        begin = time.monotonic()
        try:
            test(driver)
            passed += 1
            print(f"{test.__name__}: passed, {time.monotonic() - begin:.0f} s")
        except Exception:
            failed += 1
            traceback.print_exc(limit=3, file=sys.stdout)
            driver.switch_to.default_content()
            driver.save_screenshot(str(folder / f"failed-{test.__name__}.png"))
            print(f"{test.__name__}: FAILED")
    severe = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
    if severe:
        failed += 1
        print("FAILED: the console says", severe[0])
    driver.quit()
    print(f"Screenshots are in {folder}.")
    print(f"{passed} passed, {failed} failed")
    sys.exit(failed != 0)


main()
