"""Tasks by rules and by a language model."""

import http.server
import json
import threading

import pytest

import simwright as sw


@pytest.fixture(scope="module")
def chest(tmp_path_factory):
    folder = tmp_path_factory.mktemp("chest")
    made, = sw.assets.library("drawer_unit", folder, check=False, progress=False)
    return made["folder"]


@pytest.fixture(scope="module")
def by_rules(chest, tmp_path_factory):
    output = tmp_path_factory.mktemp("rules") / "tasks.json"
    sw.tasks.make(chest, output, progress=False)
    return sw.tasks.read(output)["tasks"]


@pytest.fixture
def server(by_rules):
    """A language model that always answers with the program of the first task by rules."""
    program = "\n".join(by_rules[0]["subtasks"][0]["program"])
    answer = f'Task: open_it\nTask Description: "Open it."\n```python\n{program}\n```\n'
    requests = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_POST(self):
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            requests.append((self.path, self.headers.get("Authorization"), body))
            reply = json.dumps({"choices": [{"message": {"role": "assistant", "content": answer},
                                             "finish_reason": "stop"}]}).encode()
            self.send_response(200)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(reply)))
            self.end_headers()
            self.wfile.write(reply)

        def log_message(self, *arguments):
            pass

    running = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=running.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{running.server_port}/v1", requests
    running.shutdown()


def test_a_language_model_is_asked(chest, by_rules, server, tmp_path, monkeypatch):
    url, requests = server
    monkeypatch.setenv("SIMWRIGHT_LLM_KEY", "key-of-a-test")
    sw.tasks.make(chest, tmp_path / "tasks.json", count=1, llm=url, llm_model="parrot",
                  llm_cache=tmp_path / "cache", progress=False)
    task, = sw.tasks.read(tmp_path / "tasks.json")["tasks"]
    assert task["subtasks"][0]["program"] == by_rules[0]["subtasks"][0]["program"]
    path, key, body = requests[0]
    assert (path, key, body["model"]) == ("/v1/chat/completions", "Bearer key-of-a-test", "parrot")
    # The second time, the cache answers.
    asked = len(requests)
    sw.tasks.make(chest, tmp_path / "again.json", count=1, llm=url, llm_model="parrot",
                  llm_cache=tmp_path / "cache", progress=False)
    assert len(requests) == asked


@pytest.mark.parametrize("call, word", [
    (lambda file: sw.tasks.train(file, "open_*", "out", num_envs=0), "num_envs"),
    (lambda file: sw.tasks.train(file, 3, "out"), "task: is 3"),
    (lambda file: sw.tasks.rollout("out", seed=-1), "seed"),
    (lambda file: sw.tasks.export("out", file, episodes=0), "episodes"),
    (lambda file: sw.tasks.export("out", file, pace="fast"), "pace: is 'fast'"),
    (lambda file: sw.tasks.make(3, file), "assets"), (lambda file: sw.tasks.read(3), "file: is 3"),
])
def test_bad_arguments(call, word, tmp_path):
    with pytest.raises(sw.Error, match=word):
        call(tmp_path / "tasks.json")


def test_bad_models(chest, tmp_path, monkeypatch):
    monkeypatch.delenv("SIMWRIGHT_LLM_URL", raising=False)
    with pytest.raises(sw.Error, match="SIMWRIGHT_LLM_URL"):
        sw.tasks.make(chest, tmp_path / "a.json", llm="env", progress=False)
    with pytest.raises(sw.Error, match="llm"):
        sw.tasks.make(chest, tmp_path / "a.json", llm="http://127.0.0.1:1", replay="x",
                      progress=False)
    with pytest.raises(sw.Error):
        sw.tasks.make(chest, tmp_path / "a.json", replay=tmp_path / "missing.jsonl", progress=False)
    assert not (tmp_path / "a.json").exists()
